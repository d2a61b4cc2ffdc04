#include "tests/bench/synthesis/fidelity.h"

#include <cmath>
#include <numbers>

#include <opencv2/imgproc.hpp>

#include "host_app/view_sets/image_metrics.h"

namespace vantage {
namespace {

constexpr int outlier_box_px = 5;
constexpr double outlier_threshold = 24;

cv::Mat error_of(const ColourImage& picture, const ColourImage& truth) {
    cv::Mat error;
    cv::subtract(picture, truth, error, cv::noArray(), CV_32F);
    return error;
}

/// The largest of R, G and B.
cv::Mat largest(const cv::Mat& colours) {
    cv::Mat channels[4], most;
    cv::split(colours, channels);
    cv::max(channels[0], channels[1], most);
    cv::max(most, channels[2], most);
    return most;
}

}  // namespace

double outliers(const ColourImage& picture, const ColourImage& truth) {
    // What is only softer or shifted by less than the box averages out.
    cv::Mat error;
    cv::blur(error_of(picture, truth), error, {outlier_box_px, outlier_box_px});
    error = cv::abs(error);
    return cv::countNonZero(largest(error) > outlier_threshold) /
           static_cast<double>(picture.total());
}

void Fidelity::add(const ColourImage& picture, const ColourImage& truth) {
    psnr_db_ += vantage::psnr_db(picture, truth);
    ssim_ += vantage::ssim(picture, truth);
    outliers_ += vantage::outliers(picture, truth);
    ++pictures_;
}

void Flicker::add(const ColourImage& before, const ColourImage& truth_before,
                  const ColourImage& now, const ColourImage& truth_now, const cv::Mat1b& mask) {
    cv::Mat change;
    cv::absdiff(error_of(before, truth_before), error_of(now, truth_now), change);
    const cv::Scalar mean = cv::mean(change, mask);
    const double pixels = cv::countNonZero(mask);
    sum_ += pixels * (mean[0] + mean[1] + mean[2]) / 3;
    pixels_ += pixels;
}

double Flicker::against_a_camera() const {
    // The mean absolute difference of two values with this noise.
    const double camera = 2 * noise_sigma_ / std::sqrt(std::numbers::pi);
    return pixels_ > 0 ? sum_ / pixels_ / camera : 0;
}

}  // namespace vantage
