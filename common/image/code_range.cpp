#include "common/image/code_range.h"

namespace vantage {

int CodeRange::bits() const {
    int count = 0;
    for (int rest = white; rest > 0; rest >>= 1) ++count;
    return count;
}

CodeRange range_of_codes(const cv::Mat& picture) {
    if (picture.depth() != CV_16U) return {};
    double largest = 0;
    cv::minMaxIdx(picture.reshape(1), nullptr, &largest);
    for (const int bits : {8, 10, 12, 14})
        if (const int white = (1 << bits) - 1; largest <= white) return {white};
    return {0xffff};
}

cv::Mat to_bytes(const cv::Mat& picture, int white) {
    constexpr double white_byte = 255;
    if (picture.depth() == CV_8U && white == static_cast<int>(white_byte)) return picture;
    cv::Mat bytes;
    picture.convertTo(bytes, CV_8U, white_byte / white);
    return bytes;
}

}  // namespace vantage
