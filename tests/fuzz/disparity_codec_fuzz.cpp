#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>

#include <opencv2/core.hpp>

#include "common/wire/disparity_codec.h"
#include "tests/fuzz/input_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace vantage;
    // Small pictures show what large ones would, many times a second.
    constexpr int max_side_px = 64;
    if (size < 2) return 0;
    const int width = data[0] % max_side_px + 1;
    const int height = data[1] % max_side_px + 1;
    const std::span rest(data + 2, size - 2);
    static DisparityDecoder decoder;
    static DisparityEncoder encoder;
    expect_result_or_error([&] { decoder.decode(std::as_bytes(rest), width, height); });

    DisparityImage picture(height, width, std::uint16_t{0});
    if (!rest.empty())
        std::memcpy(picture.data, rest.data(), std::min(rest.size(), 2 * picture.total()));
    const DisparityImage back = decoder.decode(encoder.encode(picture), width, height);
    if (cv::norm(picture, back, cv::NORM_INF) != 0) std::abort();
    return 0;
}
