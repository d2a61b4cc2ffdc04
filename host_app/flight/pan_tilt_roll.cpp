#include "host_app/flight/pan_tilt_roll.h"

#include <algorithm>
#include <cmath>

namespace vantage {

PanTiltRoll pan_tilt_roll_of(const Pose& world_from_camera) {
    const Eigen::Vector3d right = world_from_camera.linear().col(0);
    const Eigen::Vector3d forward = world_from_camera.linear().col(2);
    constexpr double least_level = 1e-7;
    const bool has_direction = std::hypot(forward.x(), forward.z()) > least_level;
    PanTiltRoll turn;
    turn.pan_rad =
        has_direction ? std::atan2(forward.x(), -forward.z()) : std::atan2(right.z(), right.x());
    turn.tilt_rad = std::asin(std::clamp(forward.y(), -1.0, 1.0));
    const Eigen::Vector3d level(std::cos(turn.pan_rad), 0, std::sin(turn.pan_rad));
    turn.roll_rad = std::atan2(-right.dot(level.cross(forward)), right.dot(level));
    return turn;
}

Eigen::Matrix3d turned(const PanTiltRoll& turn) {
    const Eigen::Vector3d forward(std::sin(turn.pan_rad) * std::cos(turn.tilt_rad),
                                  std::sin(turn.tilt_rad),
                                  -std::cos(turn.pan_rad) * std::cos(turn.tilt_rad));
    const Eigen::Vector3d level(std::cos(turn.pan_rad), 0, std::sin(turn.pan_rad));
    const Eigen::Vector3d right =
        std::cos(turn.roll_rad) * level - std::sin(turn.roll_rad) * level.cross(forward);
    Eigen::Matrix3d rotation;
    rotation << right, forward.cross(right), forward;
    return rotation;
}

}  // namespace vantage
