#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "common/virtual_stage/stage_mesh.h"
#include "common/virtual_stage/stage_scene.h"
#include "common/virtual_stage/stage_textures.h"

namespace vantage {
namespace {

using Eigen::Affine3f;
using Eigen::AngleAxisf;
using Eigen::Vector3f;

/// Random numbers from a seed, equal with every standard library (unlike its distributions).
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

/// The floor area for objects: away from the performers' paths, and on the rigs' side (within 80
/// degrees of +z) only near the performers, so that nothing stands right in front of a camera.
class FreeFloor {
  public:
    explicit FreeFloor(const std::vector<PerformerStyle>& performers) {
        constexpr float gap_m = 0.08f;
        for (const PerformerStyle& performer : performers) {
            way_from_m_ = std::min(way_from_m_, performer.walk_radius_m - performer.reach_m());
            way_to_m_ = std::max(way_to_m_, performer.walk_radius_m + performer.reach_m());
        }
        way_from_m_ -= gap_m;
        way_to_m_ += gap_m;
    }

    /// A place for an object of a radius, up to `farthest_m` from the middle of the stage.
    Vector3f place(Dice& dice, float radius_m, float farthest_m) const {
        for (;;) {
            const float azimuth = dice.between(-0.5f * tau, 0.5f * tau);
            const float from_middle_m = dice.between(0, farthest_m);
            const bool off_the_way =
                from_middle_m + radius_m < way_from_m_ || from_middle_m - radius_m > way_to_m_;
            const bool in_sight = std::abs(azimuth) < rigs_side &&
                                  from_middle_m + radius_m > std::max(way_to_m_, 0.0f) + 0.7f;
            if (off_the_way && !in_sight)
                return {from_middle_m * std::sin(azimuth), 0, from_middle_m * std::cos(azimuth)};
        }
    }

  private:
    static constexpr float rigs_side = 80 * tau / 360;
    float way_from_m_ = 1e9f, way_to_m_ = 0;
};

/// Adds free-standing slanted boards between the performers and the walls.
void add_slanted_boards(StageMeshBuilder& mesh, Dice& dice, const FreeFloor& free) {
    const int boards = 5 + dice.below(5);
    for (int i = 0; i < boards; ++i) {
        mesh.begin_chunk();
        const Vector3f size_m(dice.between(0.6f, 2.0f), dice.between(0.5f, 1.6f), 0.05f);
        const Vector3f at = free.place(dice, 0.5f * size_m.norm(), 5.5f);
        mesh.set_placement(
            Affine3f(Eigen::Translation3f(at.x(), dice.between(0.4f, 2.2f), at.z())) *
            AngleAxisf(dice.between(-1.2f, 1.2f), any_direction(dice)));
        mesh.set_material(any_material(dice, 0.8f));
        mesh.box({0, 0, 0}, size_m);
        mesh.end_chunk();
    }
}

void add_thing(StageMeshBuilder& mesh, Dice& dice, const FreeFloor& free) {
    enum Thing { box, ball, column, ring, beam, things };
    const auto thing = static_cast<Thing>(dice.below(things));
    const float size = dice.between(0.15f, 0.5f), turn = dice.between(0, tau);
    const float lean = thing == beam ? dice.between(-0.8f, 0.8f) : 0;
    const float radius_m = thing == beam   ? std::abs(lean) + 0.2f
                           : thing == ring ? 1.25f * size
                                           : size;
    mesh.set_placement(Affine3f(Eigen::Translation3f(free.place(dice, radius_m, 3.4f))) *
                       AngleAxisf(turn, Vector3f::UnitY()));
    switch (thing) {
        case box:
            mesh.box({0, size, 0}, {1.4f * size, 2 * size, size});
            break;
        case ball:
            mesh.ellipsoid({0, size + dice.between(0, 1), 0},
                           {size, size * dice.between(0.6f, 1.4f), size}, 28, 18);
            break;
        case column:
            mesh.rod({0, 0, 0}, {0, dice.between(0.5f, 2.5f), 0}, 0.5f * size, 0.3f * size, 20);
            break;
        case ring:
            mesh.torus({0, size + 0.3f, 0}, size, 0.25f * size, 32, 14);
            break;
        default:
            mesh.truss({0, 0, 0}, {lean, dice.between(1.0f, 2.6f), 0}, 0.22f, 0.016f, 7);
            break;
    }
}

void add_wires(StageMeshBuilder& mesh, Dice& dice, const FreeFloor& free) {
    mesh.begin_chunk();
    mesh.set_material(matte(static_cast<int>(StageTexture::metal), any_tint(dice), 1.0f));
    const int wires = 4 + dice.below(6);
    for (int i = 0; i < wires; ++i) {
        const Vector3f half_lean(dice.between(-0.35f, 0.35f), 0, dice.between(-0.35f, 0.35f));
        const float height_m = dice.between(1.2f, 3.0f), thickness_m = dice.between(0.006f, 0.02f);
        const Vector3f middle = free.place(dice, half_lean.norm() + thickness_m, 3.5f);
        mesh.rod(middle - half_lean, middle + half_lean + Vector3f(0, height_m, 0), thickness_m,
                 thickness_m, 6);
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

/// One to three performers, evenly spaced on one circular path, so that they never meet.
std::vector<PerformerStyle> any_cast(Dice& dice) {
    std::vector<PerformerStyle> performers;
    const int count = 1 + dice.below(3);
    const float radius_m = dice.between(1.0f, 1.3f);
    const int laps = (2 + dice.below(2)) * (dice.chance(0.5f) ? 1 : -1);
    const float start = dice.between(0, 1);
    for (int i = 0; i < count; ++i) {
        PerformerStyle p;
        p.move = static_cast<PerformerMove>(dice.below(3));
        p.walk_radius_m = radius_m;
        p.laps = laps;
        p.phase = static_cast<double>(start) + static_cast<double>(i) / count;
        p.beats = 16 + 8 * dice.below(3);
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

StageScene make_random_background(std::uint64_t seed) {
    Dice dice(seed);
    StageScene scene;
    scene.texture_seed = seed;
    scene.lighting = any_lighting(dice);
    scene.performers = any_cast(dice);
    const FreeFloor free(scene.performers);
    add_room(scene.mesh, dice);
    add_slanted_boards(scene.mesh, dice, free);
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
            add_thing(scene.mesh, dice, free);
        }
        scene.mesh.end_chunk();
    }
    add_wires(scene.mesh, dice, free);
    add_sky(scene.mesh, any_tint(dice) * 0.5f);
    return scene;
}

}  // namespace vantage
