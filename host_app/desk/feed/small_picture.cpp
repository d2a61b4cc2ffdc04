#include "host_app/desk/feed/small_picture.h"

#include <algorithm>

#include <opencv2/imgproc.hpp>

namespace vantage {

ColourImage small_picture(const ColourImage& picture) {
    constexpr int most_width_px = 192;
    const double scale = std::min(1.0, static_cast<double>(most_width_px) / picture.cols);
    ColourImage small;
    cv::resize(picture, small, {}, scale, scale, cv::INTER_AREA);
    return small;
}

}  // namespace vantage
