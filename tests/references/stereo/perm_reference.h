#pragma once

#include <vector>

#include <opencv2/core.hpp>

#include "rig_firmware/stereo/volume/perm_pass.h"

namespace vantage {

/// In place of a cost that there is none of.
inline constexpr int no_cost = 0xfff;

/// The best disparity of every pixel and the aggregated costs around it.
struct Winners {
    cv::Mat1i disparity, cost, cost_before, cost_after;
    cv::Mat1i weight;  ///< what the sum of the largest cost everywhere would be
};

/// Winners to begin with, and one more disparity's costs for them: the CPU reference of
/// winner_takes_all.glsl. `last` holds the costs of the disparity before, no_cost at first.
Winners no_winners(cv::Size size);
void consider_disparity(Winners& winners, cv::Mat1i& last, const cv::Mat1i& costs, int d);

/// CPU reference of PermPass, bit for bit.
Winners perm_winners(const cv::Mat1i& left_features, const cv::Mat1i& right_features,
                     const cv::Mat1b& permeability, int disparities);

/// CPU reference of PermPass with PermOutput::costs: a picture a disparity.
std::vector<cv::Mat1b> perm_costs(const cv::Mat1i& left_features, const cv::Mat1i& right_features,
                                  const cv::Mat1b& permeability, int disparities);

/// The same, codes of at most `most_code`, from given costs, a picture a disparity.
std::vector<cv::Mat1b> perm_costs(const std::vector<cv::Mat1b>& costs,
                                  const cv::Mat1b& permeability, int most_code = max_perm_code);

/// Truncated census distance plus truncated differences of both gradients and of colour of two
/// feature words.
int feature_cost(int left, int right);
inline constexpr int most_feature_cost = 31;

/// The feature at a column of a row, of which the first repeats before the picture.
inline int feature_at(const cv::Mat1i& features, int x, int y) {
    return features(y, x > 0 ? x : 0);
}

}  // namespace vantage
