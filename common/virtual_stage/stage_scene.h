#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "common/virtual_stage/performer.h"
#include "common/virtual_stage/stage_mesh.h"

namespace vantage {

/// Directions point from the stage to the light; colours are linear light.
struct StageLighting {
    Eigen::Vector3f key_direction, key_colour;  ///< the one that casts shadows
    Eigen::Vector3f fill_direction, fill_colour;
    Eigen::Vector3f rim_direction, rim_colour;
    Eigen::Vector3f sky_colour, ground_colour;
};

/// Everything that stands on a stage.
struct StageScene {
    StageMeshBuilder mesh;
    std::vector<PerformerStyle> performers;  ///< performer i moves bones 1 + i * bones_of_performer
    StageLighting lighting;
    std::uint64_t texture_seed = 1;
};

/// The set that the demo films: a round studio with panelled walls, a lighting grid, props, and
/// three performers.
StageScene make_studio_background();

/// Another room for every seed.
StageScene make_random_background(std::uint64_t seed);

/// Set 0 is the studio, any other one random.
StageScene make_frame_set(std::uint64_t set);

/// Adds the performers' meshes and gives them their bones.
void add_performers(StageScene& scene);

/// A matte material of a texture layer.
StageMaterial matte(int texture_layer, const Eigen::Vector3f& tint, float texture_per_m);

/// A ball around everything, so that no ray leaves the stage.
void add_sky(StageMeshBuilder& mesh, const Eigen::Vector3f& tint);

}  // namespace vantage
