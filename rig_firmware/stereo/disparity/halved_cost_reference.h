#pragma once

#include <vector>

#include <opencv2/core.hpp>

namespace vantage {

/// Half-size disparity d stands for 2d - 1 .. 2d + 1.
constexpr int halved_disparities(int disparities) { return (disparities + 1) / 2; }

/// Which full-size pixels of each 2x2 are compared: the upper right one, or the mean of that and
/// the lower left one.
enum class HalvedCostSamples { one, two };

/// CPU form of HalvedCostPass: a picture a half-size disparity. The words are those of pictures of
/// an even width, whose last column was repeated where it was odd. disparities: of the full size.
std::vector<cv::Mat1b> halved_costs(const cv::Mat1i& left_features, const cv::Mat1i& right_features,
                                    int disparities, HalvedCostSamples samples);

}  // namespace vantage
