#include "host_app/views/projection.h"

#include <cmath>

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

double parallax_px(const Eigen::Matrix4d& map, const Eigen::Vector2d& pixel, double depth_m) {
    // Divided by z, the vector is linear in the inverse depth w: p(w) = (a + w * b) / (a_z + w *
    // b_z).
    const Eigen::Vector4d q = map * Eigen::Vector4d(pixel.x(), pixel.y(), 1, 1 / depth_m);
    const Eigen::Vector4d slope = map.col(3);
    if (!(depth_m > 0) || q.z() == 0) return 0;
    return (slope.head<2>() - q.head<2>() * slope.z() / q.z()).norm() / (std::abs(q.z()) * depth_m);
}

Eigen::Matrix3d scaled_intrinsics(const Eigen::Matrix3d& K, double scale_x, double scale_y) {
    // Pixel centres are at integers, so the pixels' corners scale.
    Eigen::Matrix3d scale;
    scale << scale_x, 0, 0.5 * scale_x - 0.5,  //
        0, scale_y, 0.5 * scale_y - 0.5,       //
        0, 0, 1;
    return scale * K;
}

}  // namespace vantage
