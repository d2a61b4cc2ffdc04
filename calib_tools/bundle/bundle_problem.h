#pragma once

#include <array>
#include <memory>
#include <utility>
#include <vector>

#include <ceres/loss_function.h>
#include <ceres/problem.h>

#include "calib_tools/bundle/bundle.h"
#include "calib_tools/bundle/lens_projection.h"

namespace vantage {

/// The bundle as a Ceres problem. Poses are solved as small changes (rotation vector, translation)
/// to those of the bundle, R = exp(w) R0 and t = t0 + dt. Uncertainties are then in the tangent
/// space, and no rotation has a singularity.
class BundleProblem {
  public:
    using Change = std::array<double, 6>;

    /// The bundle must outlive the problem.
    BundleProblem(const Bundle& bundle, double huber_px);

    ceres::Problem& problem() { return *problem_; }
    /// Parameter blocks in the order of the bundle's parts; null for a part without views.
    double* lens(std::size_t camera) { return used(lenses_[camera].data()); }
    double* camera_pose(std::size_t camera) { return used(camera_poses_[camera].data()); }
    double* rig_pose(std::size_t rig) { return used(rig_poses_[rig].data()); }
    double* face_pose(std::size_t face) { return used(face_poses_[face].data()); }
    double* board_pose(std::size_t board) { return used(board_poses_[board].data()); }

    /// Number of residual rows after those of the corners: 18 for every camera with a prior.
    int prior_rows() const { return prior_count_ * (lens_parameter_count + 6); }

    /// Writes the solved values into the bundle.
    void apply_to(Bundle& bundle) const;

  private:
    double* used(double* block) { return problem_->HasParameterBlock(block) ? block : nullptr; }

    std::vector<std::array<double, lens_parameter_count>> lenses_;
    int prior_count_ = 0;
    std::vector<Change> camera_poses_, rig_poses_, face_poses_, board_poses_;
    std::unique_ptr<ceres::LossFunction> loss_;  ///< loss of all corners; null: none
    std::unique_ptr<ceres::Problem> problem_;
};

/// Applies exp(change) to a pose.
Pose changed(const Pose& pose, const BundleProblem::Change& change);

}  // namespace vantage
