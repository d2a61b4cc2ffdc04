#include "common/virtual_stage/stage_scene.h"

#include <cmath>
#include <numbers>

#include "common/virtual_stage/stage_textures.h"

namespace vantage {

StageMaterial matte(int texture_layer, const Eigen::Vector3f& tint, float texture_per_m) {
    StageMaterial material;
    material.texture_layer = texture_layer;
    material.tint = tint;
    material.texture_per_m = texture_per_m;
    return material;
}

namespace {

/// Adds the performers' meshes and assigns their bones.
void add_performers(StageScene& scene) {
    int bone = 1;
    for (const PerformerStyle& performer : scene.performers) {
        scene.mesh.begin_chunk({.shadow = ShadowLookup::vertex, .animated = true});
        add_performer(scene.mesh, performer, bone);
        scene.mesh.end_chunk();
        bone += bones_of_performer;
    }
}

}  // namespace

StageScene make_scene(std::uint64_t scene) {
    const std::uint64_t seed = scene % plain_performers;
    StageScene made = seed == 0 ? make_studio_background() : make_random_background(seed);
    if (scene >= plain_performers)
        for (PerformerStyle& performer : made.performers)
            for (StageMaterial* worn : {&performer.skin, &performer.hair, &performer.top,
                                        &performer.bottom, &performer.shoes})
                worn->texture_layer = static_cast<int>(StageTexture::plain);
    add_performers(made);
    return made;
}

void add_sky(StageMeshBuilder& mesh, const Eigen::Vector3f& tint) {
    constexpr float radius_m = 40;
    StageMaterial material = matte(0, tint, 0.2f);
    material.glow = 0.5f;
    mesh.begin_chunk(far_scenery);
    mesh.set_material(material);
    constexpr float pi = std::numbers::pi_v<float>;
    mesh.patch(32, 16, [&](float s, float t) {
        const float azimuth = 2 * pi * s, polar = pi * t;
        const Eigen::Vector3f out(std::sin(polar) * std::sin(azimuth), std::cos(polar),
                                  std::sin(polar) * std::cos(azimuth));
        return SurfacePoint{radius_m * out, -out, Eigen::Vector2f(16 * s, 8 * t)};
    });
    mesh.end_chunk();
}

}  // namespace vantage
