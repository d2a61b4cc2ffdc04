#pragma once

#include <chrono>
#include <span>

#include <Eigen/Geometry>

#include "common/virtual_stage/stage_mesh.h"

namespace vantage {

/// The period of all motion on a stage. It divides a day.
inline constexpr std::chrono::seconds stage_loop{24};

/// The stage's position in its loop, 0 <= share < 1: exact at any date, also before 1970.
double loop_share(std::chrono::nanoseconds stage_time);

enum class PerformerMove { walk, dance, sing };

/// The appearance and motion of one performer: a jointed figure that walks around the middle of the
/// stage at constant speed.
struct PerformerStyle {
    PerformerMove move = PerformerMove::walk;
    float walk_radius_m = 1.1f;
    int laps = 3;      ///< per loop of the stage; below 0: clockwise from above
    double phase = 0;  ///< 0..1 of a lap: where the performer starts
    int beats = 24;    ///< of dancing or singing per loop, a multiple of 8
    float height_m = 1.75f;
    StageMaterial skin, hair, top, bottom, shoes;
    bool long_hair = false;
    bool skirt = false;

    double speed_m_per_s() const;
    /// The largest distance of any part of the figure from its path.
    float reach_m() const;
};

inline constexpr int bones_of_performer = 11;

/// Adds the figure's meshes, each in the frame of its bone, numbered from first_bone.
void add_performer(StageMeshBuilder& builder, const PerformerStyle& style, int first_bone);

/// Computes the poses of the figure's bones at a time since 1970. Feet stand on the floor.
void pose_performer(const PerformerStyle& style, std::chrono::nanoseconds stage_time,
                    std::span<Eigen::Affine3f> world_from_bone);

}  // namespace vantage
