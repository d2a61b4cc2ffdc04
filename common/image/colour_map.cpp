#include "common/image/colour_map.h"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

namespace vantage {

ColourImage colour_map_disparity(const cv::Mat1f& disparity_px, float min_px, float max_px) {
    cv::Mat1b ramp(1, 256);
    for (int i = 0; i < 256; ++i) ramp(0, i) = static_cast<unsigned char>(i);
    cv::Mat3b turbo_bgr;
    cv::applyColorMap(ramp, turbo_bgr, cv::COLORMAP_TURBO);
    const float scale = 255.0f / std::max(max_px - min_px, 1e-6f);
    ColourImage picture(disparity_px.size());
    for (int y = 0; y < picture.rows; ++y)
        for (int x = 0; x < picture.cols; ++x) {
            const float d = disparity_px(y, x);
            if (!(d > 0) || !std::isfinite(d)) {
                picture(y, x) = cv::Vec4b(0, 0, 0, 255);
                continue;
            }
            const int index = static_cast<int>(std::clamp((d - min_px) * scale, 0.0f, 255.0f));
            const cv::Vec3b& c = turbo_bgr(0, index);
            picture(y, x) = cv::Vec4b(c[2], c[1], c[0], 255);
        }
    return picture;
}

cv::Mat1f to_float_px(const DisparityImage& disparity) {
    cv::Mat1f px;
    disparity.convertTo(px, CV_32F, 1.0 / disparity_steps_per_px);
    return px;
}

}  // namespace vantage
