#include "tests/bench/stereo/opencv_matchers.h"

#include <algorithm>

#include <opencv2/imgproc.hpp>

#include "tests/references/stereo/row_fill_reference.h"

namespace vantage {

OpenCvMatcher::OpenCvMatcher(OpenCvMode mode, int disparities, int prefilter_cap)
    : disparities_((disparities + 15) / 16 * 16) {
    if (mode == OpenCvMode::bm) {
        matcher_ = cv::StereoBM::create(disparities_, 15);
    } else {
        constexpr int block = 3, p1 = 8 * block * block, p2 = 32 * block * block;
        matcher_ = cv::StereoSGBM::create(
            0, disparities_, block, p1, p2, 1, prefilter_cap, 10, 100, 2,
            mode == OpenCvMode::hh4 ? cv::StereoSGBM::MODE_HH4 : cv::StereoSGBM::MODE_SGBM_3WAY);
    }
}

cv::Mat1f OpenCvMatcher::match(const GreyImage& left, const GreyImage& right, bool padded) {
    cv::Mat l = left, r = right, raw;
    if (padded) {
        cv::copyMakeBorder(left, l, 0, 0, disparities_, 0, cv::BORDER_REPLICATE);
        cv::copyMakeBorder(right, r, 0, 0, disparities_, 0, cv::BORDER_REPLICATE);
    }
    matcher_->compute(l, r, raw);
    if (padded) raw = raw.colRange(disparities_, raw.cols);
    // OpenCV's sixteenths to ours, unknown (negative) to 0.
    DisparityImage disparity(raw.size());
    for (int y = 0; y < raw.rows; ++y)
        for (int x = 0; x < raw.cols; ++x) {
            const int value = raw.at<short>(y, x);
            disparity(y, x) = static_cast<unsigned short>(value < 0 ? 0 : std::max(value * 2, 1));
        }
    cv::Mat1f result;
    filled_from_background(disparity).convertTo(result, CV_32F, 1.0 / disparity_steps_per_px);
    return result;
}

}  // namespace vantage
