#pragma once

#include <span>

#include <opencv2/core.hpp>

#include "common/image/image.h"

namespace vantage {

/// The mean over the mask's pixels and colours of the standard deviation over time in grey levels.
/// Precondition: at least two images of one size.
inline double deviation_along_time(std::span<const ColourImage> pictures, const cv::Mat1b& mask) {
    cv::Mat sum = cv::Mat::zeros(mask.size(), CV_64FC4), squares = sum.clone();
    for (const ColourImage& picture : pictures) {
        cv::Mat wide;
        picture.convertTo(wide, CV_64F);
        sum += wide;
        squares += wide.mul(wide);
    }
    const double count = static_cast<double>(pictures.size());
    cv::Mat variance = squares / count - (sum / count).mul(sum / count), deviation;
    cv::max(variance, 0.0, variance);
    cv::sqrt(variance, deviation);
    const cv::Scalar mean = cv::mean(deviation, mask);
    return (mean[0] + mean[1] + mean[2]) / 3;
}

}  // namespace vantage
