#pragma once

#include <array>

#include <Eigen/Core>

#include "common/virtual_stage/virtual_stage.h"

namespace vantage {

/// World to GL clip space for a camera with pixel centres at integers, including skew. Row 0 of the
/// image is the first row of the framebuffer; w is the depth along the camera's z axis.
Eigen::Matrix4f clip_from_world(const StageCamera& camera, double near_m, double far_m);

/// Parallel projection along a light's direction: a cube of half_size_m around `centre_m`.
Eigen::Matrix4f clip_from_world_parallel(const Eigen::Vector3f& direction_to_light,
                                         const Eigen::Vector3f& centre_m, float half_size_m);

/// The six planes of a clip volume, with unit normals that point inwards.
using Frustum = std::array<Eigen::Vector4f, 6>;
Frustum frustum_of(const Eigen::Matrix4f& clip_from_world);
bool may_see_sphere(const Frustum& frustum, const Eigen::Vector3f& centre_m, float radius_m);

}  // namespace vantage
