#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>

#include "common/base/error.h"
#include "common/image/netpbm.h"
#include "common/image/png.h"

/// The input is a file; that of a JPEG is colour_codec's.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto bytes = std::as_bytes(std::span(data, size));
    for (const auto decode : {vantage::decode_png, vantage::decode_netpbm}) {
        try {
            const cv::Mat image = decode(bytes);
            if (image.empty() || (image.channels() != 1 && image.channels() != 3)) std::abort();
        } catch (const vantage::Error&) {
        }
    }
    return 0;
}
