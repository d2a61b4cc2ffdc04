#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>

#include "common/base/error.h"
#include "common/image/jpeg.h"
#include "common/image/netpbm.h"
#include "common/image/png.h"

/// The input is a file, which each decoder reads or refuses. colour_codec has the strict decoder of
/// the stream.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto bytes = std::as_bytes(std::span(data, size));
    using Decode = cv::Mat (*)(std::span<const std::byte>);
    constexpr Decode decoders[] = {
        [](std::span<const std::byte> file) { return vantage::decode_png(file).image; },
        [](std::span<const std::byte> file) { return vantage::decode_netpbm(file).image; },
        [](std::span<const std::byte> file) { return vantage::decode_jpeg(file).image; },
    };
    for (const Decode decode : decoders) {
        try {
            const cv::Mat image = decode(bytes);
            if (image.empty() || (image.channels() != 1 && image.channels() != 3)) std::abort();
        } catch (const vantage::Error&) {
        }
    }
    return 0;
}
