#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calib_tools/bundle/bundle.h"

namespace vantage {

/// Corners seen by one camera: one entry for every frame set, empty if it saw no board.
struct CameraViews {
    int width_px = 0, height_px = 0;
    std::vector<BoardCorners> instants;
};

/// The one or two poses camera_from_board that explain the view of a flat board (planar PnP), the
/// better one first. From far away, a board and its mirrored tilt look nearly the same. Empty for
/// fewer than four corners or corners in a line.
std::vector<Pose> board_pose_candidates(const CameraModel& camera, const BoardCorners& corners);

/// The best pose camera_from_board (planar PnP; the one with the smaller error of two). Empty for
/// fewer than four corners or corners in a line.
std::optional<Pose> estimate_board_pose(const CameraModel& camera, const BoardCorners& corners);

/// Calibrates one camera with Zhang's method ("A flexible new technique for camera calibration",
/// 2000), made robust. It tries several focal lengths as a start, takes poses from planar PnP, and
/// then solves for everything with a robust loss. The bundle has one camera, one rig at the world's
/// origin, and board i for frame set i. Empty if no start leads to a finite solution.
std::optional<Bundle> solve_camera(const CameraViews& views, const LensFamily& family);

/// Solves with a loss that counts residuals beyond 3 sigma linearly, with the robust sigma of the
/// corners. Returns false like solve_bundle().
bool solve_robustly(Bundle& bundle);

/// Robust standard deviation of the corners: 1.4826 * median of the residuals' absolute
/// coordinates.
double robust_sigma_px(const Bundle& bundle);

/// Reason why this lens is not possible, which completes a sentence: its focal length, its
/// principal point, or a distortion that folds the image within the field of view. Empty if it is
/// possible.
std::string implausibility(const CameraModel& camera);

}  // namespace vantage
