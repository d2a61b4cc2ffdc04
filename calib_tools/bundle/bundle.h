#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "calib_tools/bundle/lens_family.h"
#include "common/board/board_view.h"
#include "common/geometry/camera_model.h"
#include "common/geometry/pose.h"

namespace vantage {

// Bundle adjustment: a whole calibration as one least-squares problem (Triggs et al., "Bundle
// adjustment - a modern synthesis", 1999). A camera sits on a rig, rigs and boards stand in the
// world, and a view holds the corners of one board in one camera. The world may be a rig's own
// frame.

/// Result of an earlier calibration of a camera: values and standard deviations. A deviation of 0
/// means that the value is not constrained.
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
    const LensFamily* family =
        nullptr;  ///< determines which coefficients may be solved; never null
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

/// One of several boards that are fixed to each other, such as those of a cube.
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
    /// Faces by BoardCorner::board. Empty if all boards are separate; corners are then in their
    /// board's own frame.
    std::vector<BundleFace> faces;
    std::vector<BundleView> views;
    /// Assumed standard deviation of a corner, which sets the weight of the priors.
    double corner_sigma_px = 0.1;

    /// Predicted minus detected pixel of a corner in a view; a large value if the corner is behind
    /// the camera.
    Eigen::Vector2d residual_px(const BundleView& view, const BoardCorner& corner) const;
    /// RMS distance over the corners of a view; 0 without corners.
    double view_rms_px(const BundleView& view) const;
    /// RMS over all corners of all views, as OpenCV defines it.
    double rms_px() const;
    std::size_t corner_count() const;
};

struct BundleOptions {
    double huber_px = 0;  ///< larger residuals count linearly; 0: plain least squares
    int max_iterations = 100;
};

/// Solves for all parts of the bundle that are marked as free, in place. It uses one thread, since
/// sums of several threads change their order, and the same images must give the same digits.
/// Returns false if the problem could not be solved (not finite, or no progress from a bad start).
bool solve_bundle(Bundle& bundle, const BundleOptions& options);

/// Standard deviations (1 sigma) at a solution. Each is the larger of two estimates: the usual one,
/// from the Jacobian and the residuals' variance, and the sandwich estimator clustered by board,
/// which lets the residuals of one board pose be correlated. Bent boards and moving hands cause
/// errors of a whole view.
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
    std::vector<Rig> faces;        ///< about the axes of their board
    double residual_sigma_px = 0;  ///< of one coordinate of one corner
};

/// Throws Error if the images do not determine every parameter (the normal matrix is singular).
BundleUncertainty bundle_uncertainty(const Bundle& bundle);

}  // namespace vantage
