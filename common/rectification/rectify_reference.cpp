#include "common/rectification/rectify_reference.h"

#include <cmath>

namespace vantage {
namespace {

const cv::Vec4b outside(0, 0, 0, 255);

const cv::Vec4b& raw_at(const ColourImage& raw, int x, int y) {
    const bool inside = x >= 0 && y >= 0 && x < raw.cols && y < raw.rows;
    return inside ? raw(y, x) : outside;
}

cv::Vec4b sample(const ColourImage& raw, const cv::Vec2f& position) {
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
        const int upper = raw_at(raw, x, y)[c] * (256 - right) + raw_at(raw, x + 1, y)[c] * right;
        const int lower =
            raw_at(raw, x, y + 1)[c] * (256 - right) + raw_at(raw, x + 1, y + 1)[c] * right;
        result[c] =
            static_cast<unsigned char>((upper * (256 - below) + lower * below + 32768) >> 16);
    }
    return result;
}

}  // namespace

ColourImage rectify_reference(const ColourImage& raw, const cv::Mat2f& positions) {
    ColourImage rectified(positions.size());
    for (int y = 0; y < rectified.rows; ++y)
        for (int x = 0; x < rectified.cols; ++x) rectified(y, x) = sample(raw, positions(y, x));
    return rectified;
}

}  // namespace vantage
