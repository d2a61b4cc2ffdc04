#include "host_app/views/projection.h"

#include <Eigen/LU>

namespace vantage {
namespace {

Eigen::Matrix4d homogeneous(const Eigen::Matrix3d& K) {
    Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
    m.topLeftCorner<3, 3>() = K;
    return m;
}

}  // namespace

Eigen::Matrix4d target_from_pixel(const VirtualView& target, const Pose& world_from_camera,
                                  const Eigen::Matrix3d& K) {
    const Pose target_from_camera = target.world_from_camera.inverse() * world_from_camera;
    return target_from_camera.matrix() * homogeneous(K.inverse());
}

Eigen::Matrix4d pixel_from_target_pixel(const DepthView& source, const VirtualView& target) {
    const Pose source_from_target = source.world_from_camera.inverse() * target.world_from_camera;
    return homogeneous(source.K) * source_from_target.matrix() * homogeneous(target.K.inverse());
}

Eigen::Matrix4d clip_from_target(const VirtualView& target, double near_m) {
    const double sx = 2.0 / target.width_px, sy = 2.0 / target.height_px;
    Eigen::Matrix4d clip_from_pixel;
    clip_from_pixel << sx, 0, 0.5 * sx - 1, 0,  //
        0, sy, 0.5 * sy - 1, 0,                 //
        0, 0, 1, -2 * near_m,                   //
        0, 0, 1, 0;
    return clip_from_pixel * homogeneous(target.K);
}

Eigen::Matrix3d scaled_intrinsics(const Eigen::Matrix3d& K, double scale_x, double scale_y) {
    // Pixel centres are at integers, so it is the pixels' corners that scale.
    Eigen::Matrix3d scale;
    scale << scale_x, 0, 0.5 * scale_x - 0.5,  //
        0, scale_y, 0.5 * scale_y - 0.5,       //
        0, 0, 1;
    return scale * K;
}

}  // namespace vantage
