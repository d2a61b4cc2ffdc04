#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "common/config/stage_cameras.h"
#include "common/geometry/pair_aim.h"

namespace vantage {

/// Limits within which two single cameras are formed into a stereo rig.
struct PairLimits {
    double most_angle_deg = 25;  ///< between the optical axes
    double most_roll_deg = 20;   ///< of one camera about its axis against the other
    double least_overlap = 0.5;  ///< share of the view that both see, at the stage's distance
    double least_baseline_m = 0.02;
    double most_baseline_share = 0.5;  ///< baseline relative to the distance of the stage
};

/// Two cameras of a stage and how they would work as a rig.
struct CameraPair {
    std::size_t left = 0, right = 0;  ///< indices of the cameras
    double baseline_m = 0, angle_deg = 0, roll_deg = 0;
    double distance_m = 0;  ///< from the left camera to the middle of the stage
    double overlap = 0;     ///< of the views, at that distance
    StereoCalibration calibration = {};
    int disparities = 64;  ///< for the matcher
    std::string fault =
        {};  ///< the first limit that it breaks, with the numbers; empty: it is a rig
};

struct CameraPairs {
    std::vector<CameraPair> pairs;  ///< rigs; no camera is in two of them
    struct Single {
        std::size_t camera = 0;
        std::string reason;  ///< why it is in no pair, with the numbers of its nearest neighbour
    };
    std::vector<Single> singles;
};

/// The point that is nearest to the optical axes of all cameras: the middle of the stage. For
/// parallel axes it is 3 m ahead of the first camera.
Eigen::Vector3d middle_of_stage(const std::vector<SingleCamera>& cameras);

/// The pair of two cameras, rectified, with its place on the stage. The one that stands further to
/// the left is the left one.
CameraPair pair_of(const std::vector<SingleCamera>& cameras, std::size_t a, std::size_t b,
                   const Eigen::Vector3d& middle, const PairLimits& limits, double alpha);

/// Forms rigs of the cameras: of all pairs within the limits those with the largest overlap first.
CameraPairs form_pairs(const std::vector<SingleCamera>& cameras, const PairLimits& limits,
                       double alpha);

}  // namespace vantage
