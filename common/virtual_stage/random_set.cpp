#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "common/virtual_stage/stage_scene.h"
#include "common/virtual_stage/stage_textures.h"

namespace vantage {
namespace {

using Eigen::Affine3f;
using Eigen::AngleAxisf;
using Eigen::Vector3f;

constexpr float tau = 2 * std::numbers::pi_v<float>;

/// Numbers from a seed, the same with every standard library (unlike its distributions).
class Dice {
  public:
    explicit Dice(std::uint64_t seed) : engine_(seed) {}
    float between(float low, float high) {
        return low + (high - low) * static_cast<float>(engine_() >> 40) / 16777216.0f;
    }
    int below(int n) { return static_cast<int>(engine_() % static_cast<std::uint64_t>(n)); }
    bool chance(float p) { return between(0, 1) < p; }

  private:
    std::mt19937_64 engine_;
};

Vector3f any_direction(Dice& dice) {
    const float z = dice.between(-1, 1), turn = dice.between(0, tau), r = std::sqrt(1 - z * z);
    return {r * std::cos(turn), z, r * std::sin(turn)};
}

Vector3f any_tint(Dice& dice) {
    return {dice.between(0.5f, 1.0f), dice.between(0.5f, 1.0f), dice.between(0.5f, 1.0f)};
}

StageMaterial any_material(Dice& dice, float texture_per_m) {
    // One surface in eight has no texture.
    const int layer = dice.chance(0.125f) ? 0 : 1 + dice.below(stage_texture_count - 1);
    return matte(layer, any_tint(dice), texture_per_m * dice.between(0.7f, 1.6f));
}

void add_room(StageMeshBuilder& mesh, Dice& dice) {
    const int sides = 4 + dice.below(9);
    const float height = dice.between(3.5f, 6.0f), radius = dice.between(6.0f, 9.0f);
    mesh.begin_chunk({.casts_shadow = false});
    mesh.set_material(any_material(dice, 0.45f));
    mesh.ring({0, 0, 0}, 0.0f, radius * 1.6f, 48, 14);
    mesh.set_placement(Affine3f(Eigen::Translation3f(0, height, 0)) *
                       AngleAxisf(0.5f * tau, Vector3f::UnitX()));
    mesh.set_material(any_material(dice, 0.35f));
    mesh.ring({0, 0, 0}, 0.0f, radius * 1.6f, 48, 6);
    mesh.end_chunk();
    const float turn = dice.between(0, tau);
    const float half = radius * std::tan(0.5f * tau / static_cast<float>(sides));
    for (int i = 0; i < sides; ++i) {
        mesh.begin_chunk(far_scenery);
        mesh.set_placement(
            Affine3f(AngleAxisf(turn + tau * static_cast<float>(i) / static_cast<float>(sides),
                                Vector3f::UnitY())) *
            Eigen::Translation3f(0, 0, -radius));
        mesh.set_material(any_material(dice, 0.45f));
        mesh.rectangle({-half, 0, 0}, {2 * half, 0, 0}, {0, height, 0}, false, 4, 4);
        mesh.end_chunk();
    }
}

/// Boards at any slant, free-standing between the middle and the walls.
void add_slanted_boards(StageMeshBuilder& mesh, Dice& dice) {
    const int boards = 5 + dice.below(5);
    for (int i = 0; i < boards; ++i) {
        mesh.begin_chunk();
        const float azimuth = dice.between(0, tau), radius = dice.between(2.4f, 5.5f);
        mesh.set_placement(
            Affine3f(Eigen::Translation3f(radius * std::sin(azimuth), dice.between(0.4f, 2.2f),
                                          radius * std::cos(azimuth))) *
            AngleAxisf(dice.between(-1.2f, 1.2f), any_direction(dice)));
        mesh.set_material(any_material(dice, 0.8f));
        mesh.box({0, 0, 0}, {dice.between(0.6f, 2.0f), dice.between(0.5f, 1.6f), 0.05f});
        mesh.end_chunk();
    }
}

void add_thing(StageMeshBuilder& mesh, Dice& dice) {
    const float azimuth = dice.between(0, tau), radius = dice.between(0.3f, 3.2f);
    const Vector3f at(radius * std::sin(azimuth), 0, radius * std::cos(azimuth));
    mesh.set_placement(Affine3f(Eigen::Translation3f(at)) *
                       AngleAxisf(dice.between(0, tau), Vector3f::UnitY()));
    const float size = dice.between(0.15f, 0.5f);
    switch (dice.below(5)) {
        case 0:
            mesh.box({0, size, 0}, {1.4f * size, 2 * size, size});
            break;
        case 1:
            mesh.ellipsoid({0, size + dice.between(0, 1), 0},
                           {size, size * dice.between(0.6f, 1.4f), size}, 28, 18);
            break;
        case 2:
            mesh.rod({0, 0, 0}, {0, dice.between(0.5f, 2.5f), 0}, 0.5f * size, 0.3f * size, 20);
            break;
        case 3:
            mesh.torus({0, size + 0.3f, 0}, size, 0.25f * size, 32, 14);
            break;
        default:
            mesh.truss({0, 0, 0}, {dice.between(-0.8f, 0.8f), dice.between(1.0f, 2.6f), 0}, 0.22f,
                       0.016f, 7);
            break;
    }
}

void add_wires(StageMeshBuilder& mesh, Dice& dice) {
    mesh.begin_chunk();
    mesh.set_material(matte(static_cast<int>(StageTexture::metal), any_tint(dice), 1.0f));
    const int wires = 4 + dice.below(6);
    for (int i = 0; i < wires; ++i) {
        const float azimuth = dice.between(0, tau), radius = dice.between(0.5f, 3.5f);
        const Vector3f foot(radius * std::sin(azimuth), 0, radius * std::cos(azimuth));
        const Vector3f top = foot + Vector3f(dice.between(-0.7f, 0.7f), dice.between(1.2f, 3.0f),
                                             dice.between(-0.7f, 0.7f));
        const float thickness = dice.between(0.006f, 0.02f);
        mesh.rod(foot, top, thickness, thickness, 6);
    }
    mesh.end_chunk();
}

StageLighting any_lighting(Dice& dice) {
    const auto from_above = [&] {
        Vector3f direction = any_direction(dice);
        direction.y() = dice.between(0.5f, 1.2f);
        return Vector3f(direction.normalized());
    };
    const auto hue = [&](float strength) {
        return Vector3f(strength * Vector3f(dice.between(0.8f, 1.1f), dice.between(0.8f, 1.1f),
                                            dice.between(0.8f, 1.1f)));
    };
    StageLighting lighting;
    lighting.key_direction = from_above();
    lighting.key_colour = hue(dice.between(1.1f, 1.6f));
    lighting.fill_direction = from_above();
    lighting.fill_colour = hue(dice.between(0.3f, 0.6f));
    lighting.rim_direction = from_above();
    lighting.rim_colour = hue(dice.between(0.2f, 0.6f));
    lighting.sky_colour = hue(dice.between(0.4f, 0.6f));
    lighting.ground_colour = hue(dice.between(0.25f, 0.4f));
    return lighting;
}

std::vector<PerformerStyle> any_cast(Dice& dice) {
    std::vector<PerformerStyle> performers;
    const int count = 1 + dice.below(3);
    for (int i = 0; i < count; ++i) {
        PerformerStyle p;
        p.move = static_cast<PerformerMove>(dice.below(3));
        p.home_m = {dice.between(-0.8f, 0.8f), dice.between(-0.8f, 0.8f)};
        if (p.move == PerformerMove::walk) p.home_m.setZero();
        p.walk_radius_m = dice.between(0.9f, 1.4f);
        p.phase = dice.between(0, 1);
        p.tempo = dice.between(0.7f, 1.3f);
        p.height_m = dice.between(1.5f, 1.95f);
        p.skin = matte(0, Vector3f(0.86f, 0.68f, 0.56f) * dice.between(0.55f, 1.05f), 1);
        p.hair = matte(static_cast<int>(StageTexture::speckle), any_tint(dice) * 0.6f, 4);
        p.top = any_material(dice, 1.6f);
        p.bottom = any_material(dice, 1.4f);
        p.shoes = any_material(dice, 3.0f);
        p.long_hair = dice.chance(0.5f);
        p.skirt = dice.chance(0.4f);
        performers.push_back(p);
    }
    return performers;
}

}  // namespace

StageScene make_random_set(std::uint64_t seed) {
    Dice dice(seed);
    StageScene scene;
    scene.texture_seed = seed;
    scene.lighting = any_lighting(dice);
    add_room(scene.mesh, dice);
    add_slanted_boards(scene.mesh, dice);
    for (const bool glossy : {false, true}) {
        scene.mesh.begin_chunk({.glossy = glossy});
        const int things = glossy ? 1 + dice.below(3) : 6 + dice.below(7);
        for (int i = 0; i < things; ++i) {
            StageMaterial material = any_material(dice, 1.2f);
            if (glossy) {
                material.gloss = dice.between(0.3f, 1.0f);
                material.mirror = dice.chance(0.3f) ? 0.8f : 0.15f;
            }
            scene.mesh.set_material(material);
            add_thing(scene.mesh, dice);
        }
        scene.mesh.end_chunk();
    }
    add_wires(scene.mesh, dice);
    add_sky(scene.mesh, any_tint(dice) * 0.5f);
    scene.performers = any_cast(dice);
    add_performers(scene);
    return scene;
}

}  // namespace vantage
