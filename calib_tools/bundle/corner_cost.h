#pragma once

#include <ceres/cost_function.h>

#include "calib_tools/bundle/bundle.h"

namespace vantage {

/// Predicted minus detected pixel of a board's corner, as a cost for Ceres. Its parameter blocks
/// are the lens (lens_parameter_count), then the changes (rotation vector, translation) of the
/// camera's, the rig's and the board's pose, and of the face's if the bundle has faces. Derivatives
/// of poses are closed forms (Sola et al., "A micro Lie theory", 2018); only those of the lens come
/// from automatic differentiation.
class CornerCost final : public ceres::CostFunction {
  public:
    /// The bundle must outlive the cost.
    CornerCost(const Bundle& bundle, const BundleView& view, const BoardCorner& corner);
    /// Returns false if the corner is behind the camera.
    bool Evaluate(double const* const* parameters, double* residual,
                  double** jacobians) const override;

  private:
    const BundleCamera& camera_;
    const Pose& world_from_rig_;
    const Pose& world_from_board_;
    const Pose* board_from_face_;  ///< null: the bundle has no faces
    Eigen::Vector3d corner_m_;
    Eigen::Vector2d pixel_;
};

/// The rotation exp(w) by a rotation vector.
Eigen::Matrix3d rotation_of(const Eigen::Vector3d& w);

}  // namespace vantage
