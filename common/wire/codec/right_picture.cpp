#include "common/wire/codec/right_picture.h"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

namespace vantage {
namespace {

constexpr int right_quality = 95;
/// The matching costs take 160 MB at this size.
constexpr double most_pixels = 640 * 480;

}  // namespace

cv::Size background_match_size(cv::Size colour) {
    const int part =
        std::max(1, static_cast<int>(std::ceil(std::sqrt(colour.area() / most_pixels))));
    return {std::max(1, colour.width / part), std::max(1, colour.height / part)};
}

std::vector<std::byte> pack_right_picture(JpegEncoder& jpeg, const ColourImage& right) {
    const cv::Size size = background_match_size(right.size());
    if (size == right.size()) return jpeg.encode(right, right_quality, Chroma::full);
    cv::Mat sized;
    cv::resize(right, sized, size, 0, 0, cv::INTER_AREA);
    return jpeg.encode(ColourImage(sized), right_quality, Chroma::full);
}

}  // namespace vantage
