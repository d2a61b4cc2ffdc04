#pragma once

#include <Eigen/Core>
#include <Eigen/LU>

#include "common/geometry/pose.h"

namespace vantage {

/// The crossing of cameras' optical axes: the point whose squared distances from all of them have
/// the smallest sum, m.
class AxisCrossing {
  public:
    void add(const Pose& world_from_camera) {
        const Eigen::Vector3d axis = world_from_camera.linear().col(2);
        const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - axis * axis.transpose();
        sum_ += across;
        weighted_ += across * world_from_camera.translation();
    }

    /// The sum of the projections across the axes, which is singular where all are parallel.
    const Eigen::Matrix3d& sum() const { return sum_; }
    /// Precondition: the axes are not parallel, or `regularisation` is above 0. It is added to the
    /// diagonal of sum() and draws the point to the origin.
    Eigen::Vector3d point(double regularisation = 0) const {
        return (sum_ + regularisation * Eigen::Matrix3d::Identity()).inverse() * weighted_;
    }

  private:
    Eigen::Matrix3d sum_ = Eigen::Matrix3d::Zero();
    Eigen::Vector3d weighted_ = Eigen::Vector3d::Zero();
};

}  // namespace vantage
