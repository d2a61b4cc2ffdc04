#pragma once

#include <optional>
#include <vector>

#include "calib_tools/rig/camera_solver.h"
#include "common/geometry/stereo_calibration.h"

namespace vantage {

/// Relative pose of two cameras that were calibrated alone, and its spread.
struct PairStart {
    Pose right_from_left = Pose::Identity();  ///< robust median of all views
    double rotation_spread_rad = 0;           ///< median distance of the views from it
    double translation_spread_m = 0;
};

/// Robust median of several measurements of one pose: the one with the smallest median distance
/// from the others. Up to half of them may be wrong. Precondition: at least one.
PairStart middle_pose(const std::vector<Pose>& poses);

/// Relative pose from the boards that both cameras saw; empty if there is none.
std::optional<PairStart> start_pair(const Bundle& left, const Bundle& right);

/// Image pair that contradicts the relative pose of most pairs.
struct OutlyingPair {
    enum class Cause { left_half_turned, right_half_turned, other };
    int board = 0;
    Cause cause = Cause::other;
    double misfit_px = 0;  ///< RMS of one side's corners, predicted from the other side
};

/// Finds the pairs that contradict `start`: in neither direction does the board's pose in one image
/// predict its corners in the other. If turning one image by 180 degrees makes them agree, that is
/// reported as the cause. `looks_alike_half_turned`: property of the board, whose corners are then
/// numbered from the upper left of each image.
std::vector<OutlyingPair> outlying_pairs(const Bundle& left, const Bundle& right,
                                         const PairStart& start, bool looks_alike_half_turned);

/// Solves for both lenses, the relative pose and every board together. Camera 0 is the left one,
/// whose frame is that of the rig and the world; camera 1 is the right one; board i belongs to
/// frame set i. Views of one camera only contribute to that camera's lens. Empty if there is no
/// finite solution.
std::optional<Bundle> solve_pair(const Bundle& left, const Bundle& right, const PairStart& start);

/// Row differences (left minus right, in pixels) after rectification, of the corners that both
/// cameras saw.
std::vector<double> row_differences_px(const StereoCalibration& calibration, const Bundle& pair);

/// Root mean square; 0 for an empty list.
double root_mean_square(const std::vector<double>& values);

}  // namespace vantage
