#include "common/geometry/pose.h"

#include <cassert>

namespace vantage {

Pose look_at(const Eigen::Vector3d& eye_m, const Eigen::Vector3d& target_m,
             const Eigen::Vector3d& world_up) {
    assert((target_m - eye_m).norm() > 0);
    const Eigen::Vector3d forward = (target_m - eye_m).normalized();
    const Eigen::Vector3d right = forward.cross(world_up).normalized();
    const Eigen::Vector3d down = forward.cross(right);
    Pose world_from_camera = Pose::Identity();
    world_from_camera.linear().col(0) = right;
    world_from_camera.linear().col(1) = down;
    world_from_camera.linear().col(2) = forward;
    world_from_camera.translation() = eye_m;
    return world_from_camera;
}

Pose interpolate(const Pose& a, const Pose& b, double t) {
    const Eigen::Quaterniond qa(a.linear()), qb(b.linear());
    Pose result = Pose::Identity();
    result.linear() = qa.slerp(t, qb).toRotationMatrix();
    result.translation() = (1 - t) * a.translation() + t * b.translation();
    return result;
}

}  // namespace vantage
