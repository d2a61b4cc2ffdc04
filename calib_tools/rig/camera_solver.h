#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calib_tools/bundle/bundle.h"

namespace vantage {

/// What one camera saw: an entry for every instant, empty where it saw no board.
struct CameraViews {
    int width_px = 0, height_px = 0;
    std::vector<BoardCorners> instants;
};

/// The one or two poses camera_from_board that explain what a camera sees of a flat board (planar
/// PnP), the better first: from far away a board and its mirrored tilt look nearly alike. None for
/// fewer than four corners or corners in a line.
std::vector<Pose> board_pose_candidates(const CameraModel& camera, const BoardCorners& corners);

/// The pose camera_from_board that fits best (planar PnP; of its two answers the one with the
/// smaller error); empty for fewer than four corners or corners in a line.
std::optional<Pose> estimate_board_pose(const CameraModel& camera, const BoardCorners& corners);

/// Zhang's method ("A flexible new technique for camera calibration", 2000) made robust: several
/// focal lengths are tried as a start, poses come from planar PnP, everything is then solved
/// together with a loss that bad corners cannot pull. In the bundle: one camera, one rig at the
/// world's origin, and board i for instant i. Empty if no start leads to a finite solution.
std::optional<Bundle> solve_camera(const CameraViews& views, const LensFamily& family);

/// Solves with a loss that counts residuals beyond 3 sigma linearly, sigma being that of the bulk
/// of the corners. Returns false where solve_bundle does.
bool solve_robustly(Bundle& bundle);

/// 1.4826 * median of the residuals' absolute coordinates: sigma as the bulk of corners sees it.
double robust_sigma_px(const Bundle& bundle);

/// Why this lens cannot be, as the rest of a sentence: focal length, principal point, or a
/// distortion that folds the picture over within the field of view. Empty if it can.
std::string implausibility(const CameraModel& camera);

}  // namespace vantage
