#pragma once

#include <vector>

#include <opencv2/core.hpp>

#include "rig_firmware/stereo/volume/sgm_pass.h"
#include "tests/references/stereo/perm_reference.h"

namespace vantage {

/// CPU reference of SgmPass, bit for bit. costs: a picture a disparity.
Winners sgm_winners(const std::vector<cv::Mat1b>& costs, const SgmSettings& settings);

/// CPU reference of SgmCostPass.
std::vector<cv::Mat1b> sgm_costs(const cv::Mat1i& left_features, const cv::Mat1i& right_features,
                                 int disparities, int scale);

}  // namespace vantage
