#pragma once

#include <vector>

#include <opencv2/core.hpp>

#include "rig_firmware/stereo/disparity/perm_reference.h"

namespace vantage {

/// How path aggregation smooths.
struct SgmSettings {
    int p1 = 4;           ///< what a step of one disparity costs
    int p2 = 20;          ///< what any greater step costs
    bool columns = true;  ///< four paths; without: the two along the row

    /// Sums of three paths must fit a byte, and one path's value seven bits.
    int most_cost() const { return columns ? 85 - p2 : 127 - p2; }
};

/// CPU form of SgmPass, bit for bit. costs: a picture a disparity.
Winners sgm_winners(const std::vector<cv::Mat1b>& costs, const SgmSettings& settings);

/// CPU form of SgmCostPass.
std::vector<cv::Mat1b> sgm_costs(const cv::Mat1i& left_features, const cv::Mat1i& right_features,
                                 int disparities, int scale);

}  // namespace vantage
