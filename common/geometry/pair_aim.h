#pragma once

#include "common/geometry/stereo_calibration.h"

namespace vantage {

/// How the two cameras of a rig are aimed at each other, from their rectification.
struct PairAim {
    double toe_in_deg = 0;  ///< between the optical axes along the baseline; positive: they cross
    double crossing_m = 0;  ///< distance from the baseline at which they cross; 0: they do not
    double roll_deg = 0;    ///< of the right camera about its axis, against the left one
};

/// Rotation of the right camera about its optical axis relative to the left one, degrees.
double roll_between_deg(const Pose& right_from_left);

/// Precondition: the rectification is computed.
PairAim aim_of(const StereoCalibration& calibration);

/// Share of one camera's view that the other one sees too, along the middle row, of a surface at
/// this distance; the distance may be infinite. Precondition: the rectification is computed.
double shared_view(const StereoCalibration& calibration, double distance_m);

/// Share of what both cameras see at this distance, along the middle row, that the rectified
/// images keep. Precondition: the rectification is computed.
double kept_view(const StereoCalibration& calibration, double distance_m);

/// Distance at which the disparity is 0, which is the largest that can be measured. Infinite if
/// both sides have one principal point.
double farthest_m(const RectifiedStereo& rectified);

/// Numbers of disparities for which reports state the nearest distance.
inline constexpr int reported_disparities[] = {64, 128, 256};
/// Nearest distance that a matcher with so many disparities, from 0 on, can measure.
double nearest_m(const RectifiedStereo& rectified, int disparities);

/// As compute_rectification(), with a principal point for each side, so that the disparity is 0 at
/// far_m. Cameras that are toed in keep more of what they both see this way. An infinite far_m is
/// compute_rectification(). Throws Error if the cameras share nothing at that distance.
void compute_rectification_to(StereoCalibration& calibration, double alpha, double far_m);

/// The distance for compute_rectification_to() if the user states none: infinite for cameras that
/// share most of their view there, and twice the distance at which their axes cross if they are
/// toed in more than that. Precondition: the rectification is computed.
double suitable_far_m(const StereoCalibration& calibration);

}  // namespace vantage
