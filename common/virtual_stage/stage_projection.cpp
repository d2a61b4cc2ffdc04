#include "common/virtual_stage/stage_projection.h"

#include <Eigen/Geometry>

namespace vantage {

Eigen::Matrix4f clip_from_world(const StageCamera& camera, double near_m, double far_m) {
    // The centre of pixel u is at u + 0.5 of the framebuffer's width.
    const Eigen::Matrix3d& K = camera.K;
    Eigen::Matrix4d clip_from_camera = Eigen::Matrix4d::Zero();
    const double size[2] = {static_cast<double>(camera.width_px),
                            static_cast<double>(camera.height_px)};
    for (int axis = 0; axis < 2; ++axis) {
        clip_from_camera.block<1, 3>(axis, 0) = 2 / size[axis] * K.row(axis);
        clip_from_camera(axis, 2) += 1 / size[axis] - 1;
    }
    clip_from_camera(2, 2) = (far_m + near_m) / (far_m - near_m);
    clip_from_camera(2, 3) = -2 * far_m * near_m / (far_m - near_m);
    clip_from_camera(3, 2) = 1;
    return (clip_from_camera * camera.world_from_camera.inverse().matrix()).cast<float>();
}

Eigen::Matrix4f clip_from_world_parallel(const Eigen::Vector3f& direction_to_light,
                                         const Eigen::Vector3f& centre_m, float half_size_m) {
    const Eigen::Vector3d eye = (centre_m + 2 * half_size_m * direction_to_light).cast<double>();
    const Pose world_from_light = look_at(eye, centre_m.cast<double>());
    Eigen::Matrix4d clip_from_light = Eigen::Matrix4d::Identity() / half_size_m;
    clip_from_light(2, 3) = -2;
    clip_from_light(3, 3) = 1;
    return (clip_from_light * world_from_light.inverse().matrix()).cast<float>();
}

Frustum frustum_of(const Eigen::Matrix4f& clip_from_world) {
    Frustum frustum;
    std::size_t next = 0;
    for (int axis = 0; axis < 3; ++axis)
        for (const bool upper : {false, true}) {
            Eigen::Vector4f plane = clip_from_world.row(3).transpose() +
                                    (upper ? -1.0f : 1.0f) * clip_from_world.row(axis).transpose();
            plane /= plane.head<3>().norm();
            frustum[next++] = plane;
        }
    return frustum;
}

bool may_see_sphere(const Frustum& frustum, const Eigen::Vector3f& centre_m, float radius_m) {
    for (const Eigen::Vector4f& plane : frustum)
        if (plane.dot(centre_m.homogeneous()) < -radius_m) return false;
    return true;
}

}  // namespace vantage
