#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <span>

#include <opencv2/core.hpp>

namespace vantage {

/// The input of the picture codecs: two bytes for the size, then a payload, or the pixels of a
/// picture to send there and back. Small pictures show what large ones would, many times a second.
struct InputPicture {
    explicit InputPicture(std::span<const std::uint8_t> input) {
        constexpr int max_side_px = 64;
        if (input.size() < 2) return;
        width_px = input[0] % max_side_px + 1;
        height_px = input[1] % max_side_px + 1;
        rest = input.subspan(2);
    }

    template <class Image>
    Image pixels() const {
        Image picture = Image::zeros(height_px, width_px);
        if (!rest.empty())
            std::memcpy(picture.data, rest.data(),
                        std::min(rest.size(), picture.total() * picture.elemSize()));
        return picture;
    }

    int width_px = 1, height_px = 1;
    std::span<const std::uint8_t> rest;
};

/// Ends the fuzzer unless the two are the same.
inline void expect_same(const cv::Mat& a, const cv::Mat& b) {
    if (cv::norm(a, b, cv::NORM_INF) != 0) std::abort();
}

}  // namespace vantage
