#pragma once

#include <optional>
#include <vector>

#include "calib_tools/rig/camera_solver.h"
#include "common/geometry/stereo_calibration.h"

namespace vantage {

/// How well two cameras that were calibrated alone agree on one rigid rig.
struct PairStart {
    Pose right_from_left = Pose::Identity();  ///< the views' robust middle
    double rotation_spread_rad = 0;           ///< median distance of the views from it
    double translation_spread_m = 0;
};

/// Of several measurements of one pose the one whose median distance to the others is least: half
/// of them may be wrong. Precondition: at least one.
PairStart middle_pose(const std::vector<Pose>& poses);

/// From the poses of the boards that both saw. Empty if none was seen by both.
std::optional<PairStart> start_pair(const Bundle& left, const Bundle& right);

/// A pair whose pictures do not agree with the rig that most pairs agree on.
struct OutlyingPair {
    enum class Cause { left_half_turned, right_half_turned, other };
    int board = 0;
    Cause cause = Cause::other;
    double misfit_px = 0;  ///< RMS of the corners of one side as the other side predicts them
};

/// Finds the pairs that contradict `start`: in neither direction does the board's pose in one
/// picture predict its corners in the other. Where turning one of the pictures by 180 degrees mends
/// that, it is the cause. `looks_alike_half_turned`: of the board, whose corners are numbered from
/// the upper left of each picture then.
std::vector<OutlyingPair> outlying_pairs(const Bundle& left, const Bundle& right,
                                         const PairStart& start, bool looks_alike_half_turned);

/// Both lenses, the relative pose and every board together: camera 0 is the left one, whose frame
/// is the rig's and the world's; camera 1 the right one; board i belongs to instant i. Views that
/// only one camera saw help that camera's lens. Empty if there is no finite solution.
std::optional<Bundle> solve_pair(const Bundle& left, const Bundle& right, const PairStart& start);

/// Row differences (left minus right, px) of the corners that both cameras saw, after
/// rectification.
std::vector<double> row_differences_px(const StereoCalibration& calibration, const Bundle& pair);

/// Root of the mean square; 0 for none.
double root_mean_square(const std::vector<double>& values);

}  // namespace vantage
