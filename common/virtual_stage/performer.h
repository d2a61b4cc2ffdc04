#pragma once

#include <span>

#include <Eigen/Geometry>

#include "common/virtual_stage/stage_mesh.h"

namespace vantage {

enum class PerformerMove { walk, dance, sing };

/// One performer: a jointed figure with a wardrobe and something to do.
struct PerformerStyle {
    PerformerMove move = PerformerMove::walk;
    Eigen::Vector2f home_m = Eigen::Vector2f::Zero();  ///< x, z on the floor; centre of the walk
    float walk_radius_m = 1.2f;
    float phase = 0;  ///< 0..1, offsets the performer in time
    float tempo = 1;
    float height_m = 1.75f;
    StageMaterial skin, hair, top, bottom, shoes;
    bool long_hair = false;
    bool skirt = false;
};

inline constexpr int bones_of_performer = 11;

/// Adds the figure's meshes, each in the frame of its bone; bones first_bone...
void add_performer(StageMeshBuilder& builder, const PerformerStyle& style, int first_bone);

/// Where each of its bones_of_performer bones is at a time. Feet stand on the floor.
void pose_performer(const PerformerStyle& style, double time_s,
                    std::span<Eigen::Affine3f> world_from_bone);

}  // namespace vantage
