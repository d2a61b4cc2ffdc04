#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "common/virtual_stage/performer.h"
#include "common/virtual_stage/stage_mesh.h"

namespace vantage {

/// The lights of a scene. Directions point from the stage to the light; colours are linear.
struct StageLighting {
    Eigen::Vector3f key_direction, key_colour;  ///< the light that casts shadows
    Eigen::Vector3f fill_direction, fill_colour;
    Eigen::Vector3f rim_direction, rim_colour;
    Eigen::Vector3f sky_colour, ground_colour;
};

/// Everything on a virtual stage.
struct StageScene {
    StageMeshBuilder mesh;
    std::vector<PerformerStyle>
        performers;  ///< performer i has bones from 1 + i * bones_of_performer
    StageLighting lighting;
    std::uint64_t texture_seed = 1;
};

/// The scene of the demo: a round studio with panelled walls, a lighting grid, props, and three
/// performers, whose meshes are not yet there.
StageScene make_studio_background();

/// A random room from a seed. The performers' meshes are not yet there.
StageScene make_random_background(std::uint64_t seed);

/// Added to a scene's number: its performers wear plain colours, on which a matcher finds little.
inline constexpr std::uint64_t plain_performers = 1'000'000;

/// Scene 0 is the studio; every other number below plain_performers is the seed of a random one.
StageScene make_scene(std::uint64_t scene);

/// A matte material with a texture layer.
StageMaterial matte(int texture_layer, const Eigen::Vector3f& tint, float texture_per_m);

/// A sphere around everything, so that every ray hits a surface.
void add_sky(StageMeshBuilder& mesh, const Eigen::Vector3f& tint);

}  // namespace vantage
