#include <array>
#include <cmath>

#include "common/virtual_stage/stage_mesh.h"
#include "common/virtual_stage/stage_scene.h"
#include "common/virtual_stage/stage_textures.h"

namespace vantage {
namespace {

using Eigen::Affine3f;
using Eigen::AngleAxisf;
using Eigen::Vector3f;

constexpr float wall_radius_m = 7.4f, wall_height_m = 4.8f, ceiling_m = 5.6f;
constexpr int panels = 16;

StageMaterial of(StageTexture texture, const Vector3f& tint, float per_m = 0.5f) {
    return matte(static_cast<int>(texture), tint, per_m);
}

StageMaterial glowing(const Vector3f& tint, float glow) {
    StageMaterial material = of(StageTexture::plain, tint);
    material.glow = glow;
    return material;
}

/// A frame on the floor at `radius`: x to the right, y up, z towards the middle of the stage.
Affine3f facing_middle(float azimuth, float radius_m) {
    return Affine3f(AngleAxisf(azimuth + 0.5f * tau, Vector3f::UnitY())) *
           Eigen::Translation3f(0, 0, -radius_m);
}

void add_floor(StageMeshBuilder& mesh) {
    mesh.begin_chunk({.casts_shadow = false});
    mesh.set_material(of(StageTexture::poster_logo, {1, 1, 1}));
    mesh.ring({0, 0, 0}, 0.0f, 0.85f, 64, 3, true);
    mesh.set_material(of(StageTexture::carpet, {1, 1, 1}, 0.55f));
    mesh.ring({0, 0, 0}, 0.85f, 2.1f, 64, 4);
    mesh.end_chunk();
    mesh.begin_chunk({.casts_shadow = false, .glossy = true});
    StageMaterial polished = of(StageTexture::tiles, {0.62f, 0.66f, 0.72f}, 0.45f);
    polished.gloss = 0.5f;
    polished.mirror = 0.22f;
    mesh.set_material(polished);
    mesh.ring({0, 0, 0}, 2.1f, 2.75f, 64, 3);
    mesh.end_chunk();
    // In quarters, so that those outside the image are culled.
    for (int quarter = 0; quarter < 4; ++quarter) {
        mesh.begin_chunk({.casts_shadow = false});
        mesh.set_material(of(StageTexture::wood, {1, 1, 1}, 0.5f));
        mesh.patch(16, 9, [&](float s, float t) {
            const float azimuth = 0.25f * tau * (static_cast<float>(quarter) + s);
            const float radius = 2.75f + t * (wall_radius_m + 0.4f - 2.75f);
            const Vector3f at(radius * std::sin(azimuth), 0, radius * std::cos(azimuth));
            return SurfacePoint{at, Vector3f::UnitY(), Eigen::Vector2f(at.x(), at.z()) * 0.5f};
        });
        mesh.end_chunk();
    }
}

void add_framed_poster(StageMeshBuilder& mesh, StageTexture poster, float width_m, float middle_m) {
    const float h = 0.5f * width_m;
    mesh.set_material(of(StageTexture::metal, {0.35f, 0.35f, 0.40f}, 1.0f));
    mesh.box({0, middle_m - h - 0.04f, 0.06f}, {width_m + 0.16f, 0.08f, 0.12f});
    mesh.box({0, middle_m + h + 0.04f, 0.06f}, {width_m + 0.16f, 0.08f, 0.12f});
    mesh.box({-h - 0.04f, middle_m, 0.06f}, {0.08f, width_m, 0.12f});
    mesh.box({h + 0.04f, middle_m, 0.06f}, {0.08f, width_m, 0.12f});
    StageMaterial picture = of(poster, {1, 1, 1});
    picture.glow = 0.35f;
    mesh.set_material(picture);
    mesh.rectangle({-h, middle_m - h, 0.05f}, {width_m, 0, 0}, {0, width_m, 0}, true);
}

void add_wall_panel(StageMeshBuilder& mesh, int index) {
    const float width = 2 * wall_radius_m * std::tan(0.5f * tau / panels);
    const float azimuth = tau * (static_cast<float>(index) + 0.5f) / panels;
    const float h = 0.5f * width;
    struct Look {
        StageTexture texture;
        Vector3f tint;
        float per_m;
    };
    const std::array<Look, 8> looks = {{{StageTexture::brick, {0.92f, 0.86f, 0.84f}, 0.42f},
                                        {StageTexture::plaster, {0.30f, 0.62f, 0.72f}, 0.45f},
                                        {StageTexture::tiles, {0.85f, 0.88f, 0.95f}, 0.40f},
                                        {StageTexture::plaster, {0.86f, 0.55f, 0.38f}, 0.45f},
                                        {StageTexture::speckle, {0.62f, 0.70f, 0.86f}, 0.50f},
                                        {StageTexture::plain, {0.52f, 0.53f, 0.56f}, 0.50f},
                                        {StageTexture::wood, {0.95f, 0.82f, 0.70f}, 0.45f},
                                        {StageTexture::plaster, {0.58f, 0.40f, 0.66f}, 0.45f}}};
    const Look& look = looks[static_cast<std::size_t>(index) % looks.size()];
    mesh.begin_chunk(far_scenery);
    mesh.set_placement(facing_middle(azimuth, wall_radius_m));
    StageMaterial wall = of(look.texture, look.tint, look.per_m);
    wall.glow = 0.10f;
    mesh.set_material(wall);
    mesh.rectangle({-h, 0, 0}, {width, 0, 0}, {0, wall_height_m, 0}, false, 2, 4);
    mesh.set_material(of(StageTexture::metal, {0.30f, 0.31f, 0.36f}, 0.8f));
    mesh.box({0, 0.09f, 0.03f}, {width, 0.18f, 0.06f});
    mesh.rectangle({-h, wall_height_m, 0}, {width, 0, 0}, {0, ceiling_m - wall_height_m, 0});
    const Vector3f amber(1.0f, 0.78f, 0.46f), cyan(0.45f, 0.88f, 1.0f);
    mesh.set_material(glowing(index % 2 ? amber : cyan, 0.9f));
    mesh.box({0, wall_height_m, 0.05f}, {width, 0.10f, 0.10f});

    switch (index % 4) {
        case 1:
            add_framed_poster(
                mesh,
                std::array{StageTexture::poster_skyline, StageTexture::poster_shapes,
                           StageTexture::poster_logo,
                           StageTexture::poster_shapes}[static_cast<std::size_t>(index / 4)],
                2.0f, 2.15f);
            break;
        case 3:
            // Upright slats before the wall.
            mesh.set_material(of(StageTexture::wood, {0.92f, 0.74f, 0.55f}, 0.7f));
            for (int slat = -4; slat <= 4; ++slat)
                mesh.box({0.27f * static_cast<float>(slat), 1.9f, 0.22f}, {0.07f, 3.4f, 0.10f});
            break;
        case 2:
            // A shelf of boxes.
            for (int shelf = 0; shelf < 3; ++shelf) {
                const float y = 0.9f + 0.75f * static_cast<float>(shelf);
                mesh.set_material(of(StageTexture::wood, {0.75f, 0.62f, 0.55f}, 0.8f));
                mesh.box({0, y, 0.18f}, {2.2f, 0.05f, 0.36f});
                for (int i = 0; i < 6; ++i) {
                    const int kind = (index + 5 * shelf + 3 * i) % 7;
                    const float size = 0.16f + 0.035f * static_cast<float>(kind);
                    mesh.set_material(
                        of(std::array{StageTexture::plaid, StageTexture::flowers,
                                      StageTexture::stripes, StageTexture::checker,
                                      StageTexture::speckle, StageTexture::carpet,
                                      StageTexture::denim}[static_cast<std::size_t>(kind)],
                           {1, 1, 1}, 2.0f));
                    mesh.box(
                        {-0.95f + 0.37f * static_cast<float>(i), y + 0.025f + 0.5f * size, 0.18f},
                        {0.22f, size, 0.22f});
                }
            }
            break;
        default:
            break;
    }
    mesh.end_chunk();
}

void add_columns(StageMeshBuilder& mesh) {
    const float radius = wall_radius_m / std::cos(0.5f * tau / panels) - 0.10f;
    for (int quarter = 0; quarter < 4; ++quarter) {
        mesh.begin_chunk(far_scenery);
        constexpr int columns = panels / 4;
        for (int i = 0; i < columns; ++i) {
            const float azimuth = tau * static_cast<float>(quarter * columns + i) / panels;
            mesh.set_placement(facing_middle(azimuth, radius));
            mesh.set_material(of(StageTexture::plaster, {0.90f, 0.88f, 0.84f}, 0.8f));
            mesh.rod({0, 0, 0}, {0, wall_height_m + 0.3f, 0}, 0.17f, 0.15f, 16, false);
            mesh.rod({0, 0, 0}, {0, 0.30f, 0}, 0.25f, 0.21f, 16);
            mesh.set_material(glowing({1.0f, 0.86f, 0.62f}, 0.9f));
            mesh.rod({-0.24f, 0.4f, 0.02f}, {-0.24f, 4.2f, 0.02f}, 0.018f, 0.018f, 6);
            mesh.rod({0.24f, 0.4f, 0.02f}, {0.24f, 4.2f, 0.02f}, 0.018f, 0.018f, 6);
        }
        mesh.end_chunk();
    }
}

void add_ceiling(StageMeshBuilder& mesh) {
    mesh.begin_chunk(far_scenery);
    StageMaterial ceiling = of(StageTexture::speckle, {0.30f, 0.36f, 0.52f}, 0.3f);
    ceiling.glow = 0.12f;
    mesh.set_material(ceiling);
    // Upside down: it faces the floor.
    mesh.set_placement(Affine3f(Eigen::Translation3f(0, ceiling_m, 0)) *
                       AngleAxisf(0.5f * tau, Vector3f::UnitX()));
    mesh.ring({0, 0, 0}, 0.0f, wall_radius_m + 0.4f, 48, 6);
    mesh.end_chunk();
}

void add_lighting_grid(StageMeshBuilder& mesh) {
    constexpr int segments = 8;
    constexpr float radius = 3.7f, height = 4.1f;
    const auto corner = [&](int i) {
        const float azimuth = tau * static_cast<float>(i) / segments;
        return Vector3f(radius * std::sin(azimuth), height, radius * std::cos(azimuth));
    };
    for (int i = 0; i < segments; ++i) {
        mesh.begin_chunk(far_scenery);
        mesh.set_material(of(StageTexture::metal, {0.80f, 0.82f, 0.86f}, 1.0f));
        mesh.truss(corner(i), corner(i + 1), 0.30f, 0.022f, 8);
        const Vector3f at = corner(i);
        mesh.rod(at, {at.x(), ceiling_m, at.z()}, 0.010f, 0.010f, 5, false);
        // A lamp: housing, lens, and the cable it hangs on.
        const Vector3f aim = (Vector3f(0, 1, 0) - at).normalized();
        const Vector3f lamp = at + Vector3f(0, -0.40f, 0);
        mesh.set_material(of(StageTexture::metal, {0.26f, 0.27f, 0.30f}, 1.5f));
        mesh.rod(at, lamp, 0.014f, 0.014f, 6, false);
        mesh.rod(lamp - 0.16f * aim, lamp + 0.14f * aim, 0.09f, 0.14f, 14);
        mesh.set_material(
            glowing(i % 2 ? Vector3f(1.0f, 0.93f, 0.78f) : Vector3f(0.80f, 0.92f, 1.0f), 1));
        mesh.rod(lamp + 0.14f * aim, lamp + 0.15f * aim, 0.12f, 0.12f, 14);
        mesh.end_chunk();
    }
}

void add_railing(StageMeshBuilder& mesh) {
    constexpr float radius = 3.0f;
    mesh.begin_chunk();
    mesh.set_material(of(StageTexture::metal, {0.92f, 0.92f, 0.95f}, 1.0f));
    constexpr int posts = 10;
    const auto at = [&](int i, float y) {
        const float azimuth = tau * (0.34f + 0.32f * static_cast<float>(i) / (posts - 1));
        return Vector3f(radius * std::sin(azimuth), y, radius * std::cos(azimuth));
    };
    for (int i = 0; i < posts; ++i) {
        mesh.rod(at(i, 0), at(i, 0.95f), 0.018f, 0.018f, 8);
        if (i + 1 == posts) break;
        for (const float y : {0.35f, 0.65f, 0.95f})
            mesh.rod(at(i, y), at(i + 1, y), y > 0.9f ? 0.022f : 0.010f, y > 0.9f ? 0.022f : 0.010f,
                     6, false);
    }
    mesh.end_chunk();
}

void add_microphone_stand(StageMeshBuilder& mesh, float x, float z) {
    mesh.begin_chunk();
    mesh.set_material(of(StageTexture::metal, {0.55f, 0.56f, 0.60f}, 1.0f));
    const Vector3f foot(x, 0, z);
    mesh.rod(foot, foot + Vector3f(0, 0.025f, 0), 0.15f, 0.14f, 20);
    mesh.rod(foot + Vector3f(0, 0.025f, 0), foot + Vector3f(0, 1.36f, 0), 0.013f, 0.011f, 8);
    mesh.rod(foot + Vector3f(0, 1.36f, 0), foot + Vector3f(0, 1.47f, -0.10f), 0.017f, 0.022f, 10);
    mesh.set_material(of(StageTexture::checker, {0.70f, 0.70f, 0.74f}, 6.0f));
    mesh.ellipsoid(foot + Vector3f(0, 1.49f, -0.12f), {0.034f, 0.034f, 0.034f}, 14, 10);
    mesh.end_chunk();
}

void add_desk(StageMeshBuilder& mesh) {
    mesh.begin_chunk();
    mesh.set_placement(facing_middle(0.62f * tau, 3.9f));
    mesh.set_material(of(StageTexture::wood, {0.96f, 0.90f, 0.86f}, 0.8f));
    mesh.box({0, 0.40f, 0}, {2.1f, 0.72f, 0.60f});
    mesh.set_material(of(StageTexture::plain, {0.93f, 0.93f, 0.95f}));
    mesh.box({0, 0.785f, 0}, {2.3f, 0.05f, 0.78f});
    mesh.set_material(of(StageTexture::metal, {0.4f, 0.4f, 0.45f}));
    mesh.box({0, 0.02f, 0}, {2.0f, 0.04f, 0.5f});
    mesh.set_material(of(StageTexture::poster_shapes, {1, 1, 1}));
    mesh.rectangle({-0.9f, 0.12f, 0.305f}, {1.8f, 0, 0}, {0, 0.56f, 0}, true);
    mesh.set_material(of(StageTexture::flowers, {1, 1, 1}, 3.0f));
    mesh.rod({-0.7f, 0.81f, 0.1f}, {-0.7f, 0.93f, 0.1f}, 0.045f, 0.05f, 16);
    mesh.set_material(of(StageTexture::plaid, {1, 1, 1}, 3.0f));
    mesh.box({0.5f, 0.835f, 0.0f}, {0.34f, 0.05f, 0.26f});
    mesh.set_material(of(StageTexture::stripes, {1, 1, 1}, 3.0f));
    mesh.box({0.52f, 0.88f, 0.01f}, {0.30f, 0.04f, 0.22f});
    mesh.end_chunk();
}

void add_plant(StageMeshBuilder& mesh, float azimuth, float radius) {
    mesh.begin_chunk();
    const Affine3f placement = facing_middle(azimuth, radius);
    mesh.set_placement(placement);
    mesh.set_material(of(StageTexture::flowers, {0.95f, 0.80f, 0.70f}, 1.5f));
    mesh.rod({0, 0, 0}, {0, 0.38f, 0}, 0.15f, 0.21f, 18);
    mesh.set_material(of(StageTexture::speckle, {0.42f, 0.72f, 0.34f}, 1.5f));
    for (int leaf = 0; leaf < 22; ++leaf) {
        const float turn = 2.39996f * static_cast<float>(leaf);
        const float rise = 0.25f + 0.05f * static_cast<float>(leaf % 9);
        mesh.set_placement(placement * Eigen::Translation3f(0, 0.34f, 0) *
                           AngleAxisf(turn, Vector3f::UnitY()) *
                           AngleAxisf(1.15f - rise * 1.6f, Vector3f::UnitX()));
        mesh.ellipsoid({0, 0.42f, 0}, {0.055f, 0.44f, 0.010f}, 6, 6);
    }
    mesh.end_chunk();
}

void add_balls_and_blocks(StageMeshBuilder& mesh) {
    mesh.begin_chunk();
    // Plain grey: a surface without texture for the matcher.
    mesh.set_placement(Affine3f(Eigen::Translation3f(1.75f, 0, 1.05f)) *
                       AngleAxisf(0.5f, Vector3f::UnitY()));
    mesh.set_material(of(StageTexture::plain, {0.60f, 0.60f, 0.61f}));
    mesh.box({0, 0.24f, 0}, {0.48f, 0.48f, 0.48f});
    mesh.set_placement(Affine3f(Eigen::Translation3f(-1.85f, 0, 0.75f)) *
                       AngleAxisf(-0.4f, Vector3f::UnitY()));
    mesh.set_material(of(StageTexture::checker, {1, 1, 1}, 1.4f));
    mesh.box({0, 0.36f, 0}, {0.42f, 0.72f, 0.42f});
    mesh.set_placement(Affine3f(Eigen::Translation3f(1.95f, 0, -0.95f)));
    mesh.set_material(of(StageTexture::plaster, {0.92f, 0.90f, 0.86f}, 1.0f));
    mesh.rod({0, 0, 0}, {0, 0.75f, 0}, 0.24f, 0.20f, 20);
    mesh.rod({0, 0.75f, 0}, {0, 0.80f, 0}, 0.27f, 0.27f, 20);
    mesh.end_chunk();

    mesh.begin_chunk({.glossy = true});
    StageMaterial mirror = of(StageTexture::plain, {0.90f, 0.92f, 0.95f});
    mirror.mirror = 0.85f;
    mirror.gloss = 1.0f;
    mesh.set_material(mirror);
    mesh.ellipsoid({1.95f, 1.06f, -0.95f}, {0.26f, 0.26f, 0.26f}, 24, 14);
    StageMaterial lacquer = of(StageTexture::plain, {0.86f, 0.20f, 0.16f});
    lacquer.mirror = 0.15f;
    lacquer.gloss = 0.9f;
    mesh.set_material(lacquer);
    mesh.ellipsoid({-1.85f, 0.91f, 0.75f}, {0.19f, 0.19f, 0.19f}, 20, 12);
    mesh.end_chunk();
}

void add_speakers(StageMeshBuilder& mesh) {
    for (const float azimuth : {0.07f * tau, 0.30f * tau, 0.47f * tau, 0.71f * tau, 0.93f * tau}) {
        mesh.begin_chunk(far_scenery);
        mesh.set_placement(facing_middle(azimuth, 6.3f));
        mesh.set_material(of(StageTexture::speckle, {0.36f, 0.37f, 0.42f}, 1.0f));
        mesh.box({0, 0.75f, 0}, {0.62f, 1.5f, 0.55f});
        mesh.box({0.03f, 1.85f, 0}, {0.50f, 0.68f, 0.45f});
        for (const float y : {0.42f, 1.05f, 1.85f}) {
            mesh.set_material(of(StageTexture::metal, {0.60f, 0.60f, 0.64f}, 3.0f));
            const float z = y > 1.5f ? 0.225f : 0.275f;
            mesh.rod({0, y, z}, {0, y, z + 0.03f}, 0.22f, 0.21f, 20);
            mesh.set_material(of(StageTexture::checker, {0.5f, 0.5f, 0.56f}, 4.0f));
            mesh.rod({0, y, z + 0.03f}, {0, y, z + 0.05f}, 0.16f, 0.10f, 20);
        }
        mesh.end_chunk();
    }
}

void add_risers(StageMeshBuilder& mesh) {
    // Steps along a part of the wall: slanted and stepped depths.
    for (const float azimuth : {0.16f * tau, 0.56f * tau, 0.84f * tau}) {
        mesh.begin_chunk(far_scenery);
        mesh.set_placement(facing_middle(azimuth, 6.4f));
        for (int step = 0; step < 3; ++step) {
            mesh.set_material(of(step % 2 ? StageTexture::carpet : StageTexture::stripes,
                                 {0.9f, 0.9f, 0.95f}, 0.6f));
            const float rise = 0.22f * static_cast<float>(step + 1);
            mesh.box({0, 0.5f * rise, -0.35f * static_cast<float>(step)}, {1.9f, rise, 0.35f});
        }
        mesh.end_chunk();
    }
}

std::vector<PerformerStyle> cast() {
    PerformerStyle walker;
    walker.move = PerformerMove::walk;
    walker.phase = 0.62;
    walker.skin = of(StageTexture::plain, {0.86f, 0.66f, 0.54f});
    walker.hair = of(StageTexture::speckle, {0.38f, 0.24f, 0.14f}, 4.0f);
    walker.top = of(StageTexture::plaid, {1, 1, 1}, 2.2f);
    walker.bottom = of(StageTexture::denim, {1, 1, 1}, 1.5f);
    walker.shoes = of(StageTexture::speckle, {0.80f, 0.78f, 0.74f}, 4.0f);

    PerformerStyle dancer;
    dancer.move = PerformerMove::dance;
    dancer.phase = walker.phase + 1.0 / 3;
    dancer.height_m = 1.70f;
    dancer.long_hair = true;
    dancer.skirt = true;
    dancer.skin = of(StageTexture::plain, {0.70f, 0.49f, 0.37f});
    dancer.hair = of(StageTexture::speckle, {0.20f, 0.15f, 0.14f}, 4.0f);
    dancer.top = of(StageTexture::flowers, {1, 1, 1}, 1.6f);
    dancer.bottom = of(StageTexture::flowers, {1.0f, 0.92f, 0.80f}, 1.2f);
    dancer.shoes = of(StageTexture::plain, {0.85f, 0.25f, 0.28f});

    PerformerStyle singer;
    singer.move = PerformerMove::sing;
    singer.phase = walker.phase + 2.0 / 3;
    singer.beats = 16;
    singer.height_m = 1.80f;
    singer.skin = of(StageTexture::plain, {0.90f, 0.72f, 0.60f});
    singer.hair = of(StageTexture::speckle, {0.78f, 0.62f, 0.34f}, 4.0f);
    singer.top = of(StageTexture::stripes, {1, 1, 1}, 1.8f);
    singer.bottom = of(StageTexture::speckle, {0.42f, 0.42f, 0.48f}, 1.5f);
    singer.shoes = of(StageTexture::plain, {0.30f, 0.22f, 0.18f});
    return {walker, dancer, singer};
}

}  // namespace

StageScene make_studio_background() {
    StageScene scene;
    scene.lighting.key_direction = Vector3f(0.45f, 1.0f, 0.62f).normalized();
    scene.lighting.key_colour = Vector3f(1.55f, 1.40f, 1.18f);
    scene.lighting.fill_direction = Vector3f(-0.85f, 0.45f, 0.35f).normalized();
    scene.lighting.fill_colour = Vector3f(0.30f, 0.38f, 0.50f);
    scene.lighting.rim_direction = Vector3f(0.15f, 0.55f, -1.0f).normalized();
    scene.lighting.rim_colour = Vector3f(0.62f, 0.56f, 0.52f);
    scene.lighting.sky_colour = Vector3f(0.34f, 0.37f, 0.44f);
    scene.lighting.ground_colour = Vector3f(0.26f, 0.21f, 0.19f);
    StageMeshBuilder& mesh = scene.mesh;
    add_floor(mesh);
    for (int i = 0; i < panels; ++i) add_wall_panel(mesh, i);
    add_columns(mesh);
    add_ceiling(mesh);
    add_lighting_grid(mesh);
    add_railing(mesh);
    add_microphone_stand(mesh, 0, 0.06f);
    add_desk(mesh);
    add_plant(mesh, 0.28f * tau, 3.3f);
    add_plant(mesh, 0.72f * tau, 3.2f);
    add_balls_and_blocks(mesh);
    add_speakers(mesh);
    add_risers(mesh);
    add_sky(mesh, {0.16f, 0.20f, 0.30f});
    scene.performers = cast();
    return scene;
}

}  // namespace vantage
