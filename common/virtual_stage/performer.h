#pragma once

#include <chrono>
#include <span>

#include <Eigen/Geometry>

#include "common/virtual_stage/stage_mesh.h"

namespace vantage {

/// Whatever moves on a stage is back where it was after this time, without a seam. It divides the
/// day.
inline constexpr std::chrono::seconds stage_loop{24};

/// Where in its loop the stage is, 0 <= share < 1: exact at any date, also before 1970.
double loop_share(std::chrono::nanoseconds stage_time);

enum class PerformerMove { walk, dance, sing };

/// One performer: a jointed figure with a wardrobe who walks round the middle of the stage at a
/// constant speed, and what arms and trunk do meanwhile.
struct PerformerStyle {
    PerformerMove move = PerformerMove::walk;
    float walk_radius_m = 1.1f;
    int laps = 3;      ///< a loop of the stage; below 0 clockwise, seen from above
    double phase = 0;  ///< 0..1 of a lap: where on its way the performer starts
    int beats = 24;    ///< of dancing or singing in a loop, a multiple of 8
    float height_m = 1.75f;
    StageMaterial skin, hair, top, bottom, shoes;
    bool long_hair = false;
    bool skirt = false;

    double speed_m_per_s() const;
    /// How far any part of the figure gets from its way, at most.
    float reach_m() const;
};

inline constexpr int bones_of_performer = 11;

/// Adds the figure's meshes, each in the frame of its bone; bones first_bone...
void add_performer(StageMeshBuilder& builder, const PerformerStyle& style, int first_bone);

/// Where each of its bones_of_performer bones is at a time since 1970. Feet stand on the floor.
void pose_performer(const PerformerStyle& style, std::chrono::nanoseconds stage_time,
                    std::span<Eigen::Affine3f> world_from_bone);

}  // namespace vantage
