#pragma once

#include <string>

#include <Eigen/Core>
#include <nlohmann/json.hpp>
#include <opencv2/core/types.hpp>

#include "common/geometry/pose.h"

namespace vantage {

/// A camera as the cameras of an MPEG view set (TMIV, RVS) are told: axes of OMAF, the picture's
/// corner at 0, 0.
nlohmann::ordered_json omaf_camera(const std::string& name, const Pose& world_from_camera,
                                   const Eigen::Matrix3d& K, cv::Size size_px);

}  // namespace vantage
