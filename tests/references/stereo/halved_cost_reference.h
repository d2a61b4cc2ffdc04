#pragma once

#include <vector>

#include <opencv2/core.hpp>

#include "rig_firmware/stereo/volume/halved_cost_pass.h"

namespace vantage {

/// CPU reference of HalvedCostPass: a picture a half-size disparity. The words are those of
/// pictures of an even width, whose last column was repeated where it was odd. disparities: of the
/// full size.
std::vector<cv::Mat1b> halved_costs(const cv::Mat1i& left_features, const cv::Mat1i& right_features,
                                    int disparities, HalvedCostSamples samples);

/// CPU reference of PermCostPass with CostRows::pairs: a picture a disparity.
std::vector<cv::Mat1b> paired_costs(const cv::Mat1i& left_features, const cv::Mat1i& right_features,
                                    int disparities);

}  // namespace vantage
