#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "calib_tools/board/board_view.h"
#include "calib_tools/bundle/lens_family.h"
#include "common/geometry/camera_model.h"
#include "common/geometry/pose.h"

namespace vantage {

// Everything that a calibration knows and wants to know, as one least-squares problem
// (Triggs et al., "Bundle adjustment - a modern synthesis", 1999): a camera sits on a rig, a rig
// and a board stand in the world, and a view is what a camera saw of a board. The world may be a
// rig's own frame.

/// What an earlier calibration knows of a camera: values and standard deviations. A deviation of 0
/// says nothing of that value.
struct CameraPrior {
    CameraModel model;
    std::array<double, 4> focal_and_centre_sigma_px{};  ///< fx, fy, cx, cy
    std::vector<double> distortion_sigma;
    Pose camera_from_rig = Pose::Identity();
    Eigen::Vector3d rotation_sigma_rad = Eigen::Vector3d::Zero();
    Eigen::Vector3d translation_sigma_m = Eigen::Vector3d::Zero();
};

struct BundleCamera {
    CameraModel model;
    const LensFamily* family = nullptr;  ///< which coefficients may be solved; never null
    int rig = 0;
    Pose camera_from_rig = Pose::Identity();
    bool solve_lens = true;
    bool solve_pose = false;
    std::optional<CameraPrior> prior;
};

struct BundleRig {
    Pose world_from_rig = Pose::Identity();
    bool solve = false;
};

struct BundleBoard {
    Pose world_from_board = Pose::Identity();
    bool solve = true;
};

/// One of several boards that are fixed to each other and carried about as one, such as a cube's.
struct BundleFace {
    Pose board_from_face = Pose::Identity();
    bool solve = false;
};

struct BundleView {
    int camera = 0, board = 0;
    BoardCorners corners;
};

struct Bundle {
    std::vector<BundleCamera> cameras;
    std::vector<BundleRig> rigs;
    std::vector<BundleBoard> boards;
    /// By BoardCorner::board; none if every board is by itself, and corners are in its own frame.
    std::vector<BundleFace> faces;
    std::vector<BundleView> views;
    /// What a corner is trusted to, against which the deviations of priors are weighed.
    double corner_sigma_px = 0.1;

    /// Pixel that the model predicts for a corner of a view, minus the pixel seen; a large value
    /// where the corner lies behind the camera.
    Eigen::Vector2d residual_px(const BundleView& view, const BoardCorner& corner) const;
    /// Root of the mean squared distance over the corners of the view; 0 without corners.
    double view_rms_px(const BundleView& view) const;
    /// Over all corners of all views, as OpenCV states it.
    double rms_px() const;
    std::size_t corner_count() const;
};

struct BundleOptions {
    double huber_px = 0;  ///< residuals beyond this count linearly; 0: plain least squares
    int max_iterations = 100;
};

/// Improves every part of the bundle that is marked to be solved, in place, on one thread: sums of
/// several threads come in another order each time, and the same pictures have to lead to the same
/// digits. Returns false if the
/// problem could not be solved (not finite, or no progress from a hopeless start).
bool solve_bundle(Bundle& bundle, const BundleOptions& options);

/// Standard deviations (1 sigma) at a solution. Every number is the larger of two estimates: the
/// usual one, from the Jacobian and the residuals' variance, and one that lets the residuals of a
/// board's pose be correlated (the sandwich estimator clustered by board), since bent boards and
/// moving hands err a whole view at a time.
struct BundleUncertainty {
    struct Camera {
        double fx_px = 0, fy_px = 0, cx_px = 0, cy_px = 0;
        std::vector<double> distortion;
        Eigen::Vector3d rotation_rad = Eigen::Vector3d::Zero();  ///< of camera_from_rig
        Eigen::Vector3d translation_m = Eigen::Vector3d::Zero();
    };
    struct Rig {
        Eigen::Vector3d rotation_rad = Eigen::Vector3d::Zero();  ///< about the world's axes
        Eigen::Vector3d translation_m = Eigen::Vector3d::Zero();
    };
    std::vector<Camera> cameras;
    std::vector<Rig> rigs;
    std::vector<Rig> faces;        ///< about their board's axes
    double residual_sigma_px = 0;  ///< of one coordinate of one corner
};

/// Throws Error if the pictures do not determine every parameter (the normal matrix is singular).
BundleUncertainty bundle_uncertainty(const Bundle& bundle);

}  // namespace vantage
