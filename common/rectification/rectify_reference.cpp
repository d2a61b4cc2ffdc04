#include "common/rectification/rectify_reference.h"

#include <cmath>

namespace vantage {
namespace {

const cv::Vec4b black(0, 0, 0, 255);
/// Black in limited range.
const cv::Vec4b black_yuv(16, 128, 128, 255);

/// `outside`: what lies around the raw image.
cv::Vec4b sample(const ColourImage& raw, const cv::Vec2f& position, const cv::Vec4b& outside) {
    const auto raw_at = [&](int x, int y) -> const cv::Vec4b& {
        const bool inside = x >= 0 && y >= 0 && x < raw.cols && y < raw.rows;
        return inside ? raw(y, x) : outside;
    };
    const bool touches = position[0] > -1 && position[1] > -1 &&
                         position[0] < static_cast<float>(raw.cols) &&
                         position[1] < static_cast<float>(raw.rows);
    if (!touches) return outside;
    const int x256 = static_cast<int>(std::floor(position[0] * 256 + 0.5f));
    const int y256 = static_cast<int>(std::floor(position[1] * 256 + 0.5f));
    const int x = x256 >> 8, y = y256 >> 8;
    const int right = x256 & 255, below = y256 & 255;
    cv::Vec4b result;
    for (int c = 0; c < 4; ++c) {
        const int upper = raw_at(x, y)[c] * (256 - right) + raw_at(x + 1, y)[c] * right;
        const int lower = raw_at(x, y + 1)[c] * (256 - right) + raw_at(x + 1, y + 1)[c] * right;
        result[c] =
            static_cast<unsigned char>((upper * (256 - below) + lower * below + 32768) >> 16);
    }
    return result;
}

/// BT.601 of limited range in 1/8192.
cv::Vec4b colour_of_yuv(const cv::Vec4b& yuv) {
    const int y = 9539 * (yuv[0] - 16) + 4096, u = yuv[1] - 128, v = yuv[2] - 128;
    return {cv::saturate_cast<unsigned char>((y + 13075 * v) >> 13),
            cv::saturate_cast<unsigned char>((y - 3209 * u - 6660 * v) >> 13),
            cv::saturate_cast<unsigned char>((y + 16525 * u) >> 13), 255};
}

ColourImage rectify(const ColourImage& raw, const cv::Mat2f& positions, const cv::Vec4b& outside) {
    ColourImage rectified(positions.size());
    for (int y = 0; y < rectified.rows; ++y)
        for (int x = 0; x < rectified.cols; ++x)
            rectified(y, x) = sample(raw, positions(y, x), outside);
    return rectified;
}

}  // namespace

ColourImage rectify_reference(const ColourImage& raw, const cv::Mat2f& positions) {
    return rectify(raw, positions, black);
}

ColourImage rectify_yuv_reference(const ColourImage& yuv, const cv::Mat2f& positions) {
    ColourImage rectified = rectify(yuv, positions, black_yuv);
    for (int y = 0; y < rectified.rows; ++y)
        for (int x = 0; x < rectified.cols; ++x) rectified(y, x) = colour_of_yuv(rectified(y, x));
    return rectified;
}

}  // namespace vantage
