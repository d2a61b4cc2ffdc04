// The parts the stage is made of: projection, meshes, performers, textures.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <optional>
#include <random>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "common/virtual_stage/stage_mesh.h"
#include "common/virtual_stage/stage_projection.h"
#include "common/virtual_stage/stage_scene.h"
#include "common/virtual_stage/stage_textures.h"

namespace vantage {
namespace {

using Eigen::Vector3f;
using namespace std::chrono_literals;

TEST(StageProjection, PutsPixelCentresAccordingToK) {
    StageCamera camera;
    camera.width_px = 64;
    camera.height_px = 48;
    camera.K << 70, 3.5, 30.25, 0, 66, 25.75, 0, 0, 1;
    camera.world_from_camera = look_at({1, 2, 3}, {0, 0.5, -0.2});
    const Eigen::Matrix4f clip = clip_from_world(camera, 0.1, 50);
    std::mt19937 random(3);
    std::uniform_real_distribution<double> coordinate(-1, 1);
    for (int i = 0; i < 50; ++i) {
        const Eigen::Vector3d point(coordinate(random), coordinate(random), coordinate(random));
        const Eigen::Vector3d in_camera = camera.world_from_camera.inverse() * point;
        const Eigen::Vector3d pixel = camera.K * in_camera / in_camera.z();
        const Eigen::Vector4f c = clip * point.cast<float>().homogeneous();
        EXPECT_NEAR((c.x() / c.w() + 1) * 0.5f * 64 - 0.5f, pixel.x(), 1e-3);
        EXPECT_NEAR((c.y() / c.w() + 1) * 0.5f * 48 - 0.5f, pixel.y(), 1e-3);
        EXPECT_NEAR(c.w(), in_camera.z(), 1e-5);
        EXPECT_LT(std::abs(c.z()), c.w());
    }
}

TEST(StageProjection, CullsSpheresOutsideTheFrustum) {
    StageCamera camera;
    camera.width_px = camera.height_px = 100;
    camera.K << 50, 0, 49.5, 0, 50, 49.5, 0, 0, 1;  // 90 degrees
    camera.world_from_camera = look_at({0, 0, 0}, {0, 0, 1});
    const Frustum frustum = frustum_of(clip_from_world(camera, 0.1, 50));
    EXPECT_TRUE(may_see_sphere(frustum, {0, 0, 10}, 0.1f));
    EXPECT_FALSE(may_see_sphere(frustum, {0, 0, -10}, 0.1f));
    EXPECT_FALSE(may_see_sphere(frustum, {12, 0, 10}, 1.0f));
    EXPECT_TRUE(may_see_sphere(frustum, {11, 0, 10}, 1.0f)) << "reaches in by its radius";
    EXPECT_FALSE(may_see_sphere(frustum, {0, 0, 60}, 1.0f));
}

TEST(StageProjection, LightSeesTheCubeAroundItsCentre) {
    const Vector3f light = Vector3f(0.4f, 1, 0.3f).normalized(), centre(0, 1, 0);
    const Eigen::Matrix4f clip = clip_from_world_parallel(light, centre, 4);
    const Eigen::Vector4f middle = clip * centre.homogeneous();
    EXPECT_NEAR(middle.head<3>().norm(), 0, 1e-5);
    const Eigen::Vector4f nearer = clip * (centre + 2 * light).eval().homogeneous();
    EXPECT_NEAR(nearer.z(), -0.5, 1e-5) << "towards the light is nearer";
}

Vector3f position(const StageVertex& v) {
    return {v.position_m[0], v.position_m[1], v.position_m[2]};
}
Vector3f normal(const StageVertex& v) {
    return Vector3f(v.normal_and_bone[0], v.normal_and_bone[1], v.normal_and_bone[2]) / 127.0f;
}

template <class Visit>
void for_each_triangle(const StageMeshBuilder& mesh, Visit visit) {
    const auto& v = mesh.vertices();
    const auto& i = mesh.indices();
    for (std::size_t t = 0; t + 2 < i.size(); t += 3) visit(v[i[t]], v[i[t + 1]], v[i[t + 2]]);
}

/// Six times the volume that a closed mesh encloses; positive if it faces outward.
double six_volumes(const StageMeshBuilder& mesh) {
    double sum = 0;
    for_each_triangle(mesh, [&](const auto& a, const auto& b, const auto& c) {
        sum += position(a).dot(position(b).cross(position(c)));
    });
    return sum;
}

TEST(StageMesh, ClosedShapesFaceOutwardAndEncloseTheirVolume) {
    const auto volume = [](auto add) {
        StageMeshBuilder mesh;
        mesh.begin_chunk();
        // Off the origin and turned, so that a hole would show in the sum.
        mesh.set_placement(Eigen::Translation3f(5, -3, 2) *
                           Eigen::Affine3f(Eigen::AngleAxisf(0.7f, Vector3f::UnitX())));
        add(mesh);
        mesh.end_chunk();
        return six_volumes(mesh) / 6;
    };
    constexpr double pi = 3.14159265;
    EXPECT_NEAR(volume([](auto& m) { m.box({1, 2, 3}, {2, 3, 4}); }), 24, 1e-3);
    EXPECT_NEAR(volume([](auto& m) {
                    m.ellipsoid({0, 0, 0}, {1, 2, 1.5f}, 64, 48);
                }),
                4 * pi / 3 * 3, 0.1);
    EXPECT_NEAR(volume([](auto& m) { m.rod({0, 0, 0}, {0, 3, 0}, 1, 1, 64); }), 3 * pi, 0.1);
    EXPECT_NEAR(volume([](auto& m) {
                    m.rod({1, 0, 0}, {1, 0, -2}, 1, 0.5f, 64);
                }),
                2 * pi / 3 * 1.75, 0.1);
    EXPECT_NEAR(volume([](auto& m) {
                    m.torus({0, 0, 0}, 2, 0.5f, 64, 32);
                }),
                2 * pi * 2 * pi * 0.25, 0.15);
    for (const float up : {1.0f, -1.0f})
        EXPECT_NEAR(volume([up](auto& m) {
                        const std::array<LoftRing, 4> rings = {
                            {{0, 0, 0}, {0, 1, 0.5f}, {2 * up, 1, 0.5f}, {2 * up, 0, 0}}};
                        m.loft(rings, 64);
                    }),
                    pi, 0.05);
}

TEST(StageMesh, ChunksHoldTheirTrianglesAndSpheres) {
    for (const std::uint64_t seed : {0u, 1u, 2u}) {
        const StageScene scene = make_scene(seed);
        const auto& mesh = scene.mesh;
        std::uint32_t next = 0;
        for (const StageChunk& chunk : mesh.chunks()) {
            EXPECT_EQ(chunk.first_index, next);
            next += chunk.index_count;
            for (std::uint32_t i = chunk.first_index; i < next; ++i) {
                const StageVertex& v = mesh.vertices().at(mesh.indices()[i]);
                if (!chunk.kind.animated) {
                    ASSERT_LE((position(v) - chunk.centre_m).norm(), chunk.radius_m + 1e-4f);
                    ASSERT_EQ(v.normal_and_bone[3], 0);
                } else {
                    ASSERT_LE(v.normal_and_bone[3],
                              static_cast<int>(scene.performers.size()) * bones_of_performer);
                    ASSERT_GT(v.normal_and_bone[3], 0);
                }
                ASSERT_NEAR(normal(v).norm(), 1, 0.03f);
                ASSERT_LT(v.tint_and_layer[3], stage_texture_count);
            }
        }
        EXPECT_EQ(next, mesh.indices().size());
        EXPECT_GT(next / 3, 8000u);
        EXPECT_LT(next / 3, 45000u);
    }
}

/// Dates that a stage may be filmed at, in the time since 1970: then, a day in 2026, another in
/// 2260, and the moment before a loop ends.
std::vector<std::chrono::nanoseconds> dates() {
    constexpr std::chrono::seconds day_of_2026{1'795'350'007};
    return {0s, day_of_2026, std::chrono::seconds{9'151'000'003}, 5'000'000 * stage_loop - 1s, -1s};
}

using Bones = std::array<Eigen::Affine3f, bones_of_performer>;
Bones pose_of(const PerformerStyle& style, std::chrono::nanoseconds time) {
    Bones bones;
    pose_performer(style, time, bones);
    return bones;
}

TEST(Performer, StandsOnTheFloorWithinTheStageAndMovesSmoothlyAtAnyDate) {
    constexpr std::chrono::milliseconds step = 40ms;
    for (const std::chrono::nanoseconds date : dates())
        for (const PerformerStyle& style : make_studio_background().performers) {
            Bones before = pose_of(style, date - step);
            for (int i = 0; i < 75; ++i) {
                const Bones bones = pose_of(style, date + i * step);
                float lowest = 1e9f;
                for (const Eigen::Affine3f& bone : bones) {
                    EXPECT_LT(bone.translation().cwiseProduct(Vector3f(1, 0, 1)).norm(), 2.3f);
                    EXPECT_GT(bone.translation().y(), 0.02f);
                    EXPECT_LT(bone.translation().y(), 2.4f);
                    lowest = std::min(lowest, bone.translation().y());
                    // Turned and evenly scaled, never sheared.
                    const Eigen::Matrix3f m = bone.linear() / (style.height_m / 1.75f);
                    EXPECT_LT((m * m.transpose() - Eigen::Matrix3f::Identity()).norm(), 1e-4f);
                }
                EXPECT_LT(lowest, 0.65f) << "a knee at least is that low";
                float farthest = 0;
                for (std::size_t b = 0; b < bones.size(); ++b)
                    farthest = std::max(farthest,
                                        (bones[b].translation() - before[b].translation()).norm());
                EXPECT_LT(farthest, 0.16f) << "in 40 ms: no limb is faster than 4 m/s";
                EXPECT_GT(farthest, 0.02f) << "nobody stands";
                before = bones;
            }
        }
}

TEST(Performer, WalksAtThePaceOfPeopleAndMovesInStepsOfAMillisecond) {
    for (const std::uint64_t seed : {0u, 1u, 2u, 3u, 4u, 5u})
        for (const PerformerStyle& style : make_scene(seed).performers) {
            EXPECT_GE(style.speed_m_per_s(), 0.5);
            EXPECT_LE(style.speed_m_per_s(), 1.5);
            for (const std::chrono::nanoseconds date : dates())
                for (const std::chrono::nanoseconds later : {1000ms, 1ms}) {
                    const auto place = [&](std::chrono::nanoseconds time) {
                        const Vector3f pelvis = pose_of(style, time)[0].translation();
                        return Vector3f(pelvis.x(), 0, pelvis.z());
                    };
                    const double way_m = (place(date + later) - place(date)).norm();
                    const double arc_m =
                        style.speed_m_per_s() * std::chrono::duration<double>(later).count();
                    const double radius_m = static_cast<double>(style.walk_radius_m);
                    const double chord_m = 2 * radius_m * std::sin(0.5 * arc_m / radius_m);
                    EXPECT_NEAR(way_m, chord_m, 0.01 * chord_m) << later.count() << " ns";
                }
        }
}

TEST(Performer, IsTheSameAfterEveryLoop) {
    const PerformerStyle style = make_studio_background().performers[1];
    for (const std::chrono::nanoseconds date : dates()) {
        const Bones once = pose_of(style, date), again = pose_of(style, date + 7 * stage_loop);
        for (std::size_t b = 0; b < once.size(); ++b)
            EXPECT_EQ((once[b].matrix() - again[b].matrix()).norm(), 0);
    }
}

/// Cells of 4 cm over the stage, from above the floor to above everyone's hands.
class Cells {
  public:
    /// The cell of a point; empty outside.
    static std::optional<std::size_t> at(const Vector3f& p) {
        constexpr float cell_m = 0.04f;
        const Eigen::Vector3i c = ((p - Vector3f(-half_side_m, 0.03f, -half_side_m)) / cell_m)
                                      .array()
                                      .floor()
                                      .cast<int>();
        if ((c.array() < 0).any() || (c.array() >= side).any()) return std::nullopt;
        return static_cast<std::size_t>((c.x() * side + c.y()) * side + c.z());
    }
    int& operator[](std::size_t cell) { return taken_[cell]; }

  private:
    static constexpr int side = 130;
    static constexpr float half_side_m = 2.6f;
    std::vector<int> taken_ = std::vector<int>(std::size_t{side} * side * side);
};

/// Points all over the surfaces of what stands still, `apart_m` from each other.
template <class Visit>
void for_each_background_point(const StageMeshBuilder& mesh, float farthest_m, float apart_m,
                               Visit visit) {
    for_each_triangle(mesh, [&](const auto& a, const auto& b, const auto& c) {
        if (a.normal_and_bone[3] != 0) return;
        const Vector3f o = position(a), u = position(b) - o, v = position(c) - o;
        const Vector3f low = o.cwiseMin(o + u).cwiseMin(o + v),
                       high = o.cwiseMax(o + u).cwiseMax(o + v);
        if (low.x() > farthest_m || low.z() > farthest_m || high.x() < -farthest_m ||
            high.z() < -farthest_m || high.y() < 0.03f)
            return;
        const int steps =
            1 + static_cast<int>(std::max({u.norm(), v.norm(), (u - v).norm()}) / apart_m);
        for (int i = 0; i <= steps; ++i)
            for (int j = 0; i + j <= steps; ++j)
                visit(Vector3f(o + (u * static_cast<float>(i) + v * static_cast<float>(j)) /
                                       static_cast<float>(steps)));
    });
}

class EveryScene : public testing::TestWithParam<std::uint64_t> {
  protected:
    StageScene scene_ = make_scene(GetParam());
};
INSTANTIATE_TEST_SUITE_P(Scenes, EveryScene, testing::Range<std::uint64_t>(0, 13));

TEST_P(EveryScene, PerformersNeverTouchSceneryOrEachOther) {
    constexpr int the_stage = -1, nobody = 0;
    Cells cells;
    for_each_background_point(scene_.mesh, 2.6f, 0.03f, [&](const Vector3f& p) {
        if (const auto cell = Cells::at(p)) cells[*cell] = the_stage;
    });
    // By bone, the vertices of everyone.
    std::vector<std::vector<Vector3f>> of_bone(1 + scene_.performers.size() * bones_of_performer);
    for (const StageVertex& v : scene_.mesh.vertices())
        of_bone[static_cast<std::size_t>(v.normal_and_bone[3])].push_back(position(v));
    constexpr int instants = 96;
    std::array<int, 2> touched = {};  // the scenery, each other
    for (int i = 0; i < instants; ++i) {
        std::vector<std::size_t> taken;
        for (std::size_t performer = 0; performer < scene_.performers.size(); ++performer) {
            const Bones bones = pose_of(scene_.performers[performer], i * (stage_loop / instants));
            for (std::size_t b = 0; b < bones.size(); ++b)
                for (const Vector3f& v : of_bone[1 + performer * bones_of_performer + b]) {
                    const auto cell = Cells::at(bones[b] * v);
                    if (!cell) continue;
                    int& holder = cells[*cell];
                    const int who = static_cast<int>(performer) + 1;
                    if (holder == nobody) taken.push_back(*cell);
                    if (holder == the_stage) ++touched[0];
                    if (holder != nobody && holder != the_stage && holder != who) ++touched[1];
                    if (holder == nobody) holder = who;
                }
        }
        EXPECT_GT(taken.size(), 500u) << "they are among the cells";
        for (const std::size_t cell : taken) cells[cell] = nobody;
    }
    EXPECT_EQ(touched[0], 0) << "points inside the scenery";
    EXPECT_EQ(touched[1], 0) << "points that were within another performer";
}

TEST_P(EveryScene, PerformersStayWithinTheirReach) {
    std::vector<std::vector<Vector3f>> of_bone(1 + scene_.performers.size() * bones_of_performer);
    for (const StageVertex& v : scene_.mesh.vertices())
        of_bone[static_cast<std::size_t>(v.normal_and_bone[3])].push_back(position(v));
    for (std::size_t performer = 0; performer < scene_.performers.size(); ++performer) {
        const PerformerStyle& style = scene_.performers[performer];
        float farthest = 0;
        for (int i = 0; i < 96; ++i) {
            const Bones bones = pose_of(style, i * (stage_loop / 96));
            for (std::size_t b = 0; b < bones.size(); ++b)
                for (const Vector3f& v : of_bone[1 + performer * bones_of_performer + b]) {
                    const Vector3f p = bones[b] * v;
                    farthest = std::max(farthest,
                                        std::abs(std::hypot(p.x(), p.z()) - style.walk_radius_m));
                }
        }
        EXPECT_LE(farthest, style.reach_m());
        EXPECT_GT(farthest, 0.5f * style.reach_m()) << "and need it";
    }
}

TEST_P(EveryScene, NothingStandsRightInFrontOfTheRigs) {
    std::vector<Vector3f> rigs;
    for (const float azimuth : {-1.05f, -0.7f, -0.35f, 0.0f, 0.35f, 0.7f, 1.05f})
        for (const float elevation : {0.09f, 0.17f, 0.35f})
            for (const float distance : {4.0f, 4.5f})
                rigs.push_back(Vector3f(0, 1, 0) +
                               distance * Vector3f(std::cos(elevation) * std::sin(azimuth),
                                                   std::sin(elevation),
                                                   std::cos(elevation) * std::cos(azimuth)));
    float nearest = 1e9f;
    for_each_background_point(scene_.mesh, 6, 0.1f, [&](const Vector3f& p) {
        for (const Vector3f& rig : rigs) nearest = std::min(nearest, (p - rig).norm());
    });
    EXPECT_GT(nearest, 0.9f) << "metres from a camera: a low ceiling is that near";
    EXPECT_LT(nearest, 9.0f);
}

TEST(StageScene, ItsPerformersWearPlainColoursWhereAsked) {
    const StageScene textured = make_scene(4), plain = make_scene(plain_performers + 4);
    ASSERT_EQ(textured.performers.size(), plain.performers.size());
    bool has_texture = false;
    for (std::size_t i = 0; i < plain.performers.size(); ++i) {
        EXPECT_EQ(plain.performers[i].top.texture_layer, 0);
        EXPECT_EQ(plain.performers[i].bottom.texture_layer, 0);
        EXPECT_EQ(plain.performers[i].height_m, textured.performers[i].height_m);
        has_texture = has_texture || textured.performers[i].top.texture_layer != 0;
    }
    EXPECT_TRUE(has_texture);
}

TEST(StageTextures, RepeatForASeedAndDifferForAnother) {
    const auto a = draw_stage_textures(4), same = draw_stage_textures(4),
               b = draw_stage_textures(5);
    ASSERT_EQ(a.size(), static_cast<std::size_t>(stage_texture_count));
    for (std::size_t i = 0; i < a.size(); ++i) {
        ASSERT_EQ(a[i].size(), cv::Size(stage_texture_side_px, stage_texture_side_px));
        EXPECT_EQ(cv::norm(a[i], same[i], cv::NORM_INF), 0);
        const bool is_plain = i == static_cast<std::size_t>(StageTexture::plain);
        EXPECT_EQ(cv::norm(a[i], b[i], cv::NORM_INF) == 0, is_plain) << "layer " << i;
    }
}

TEST(StageTextures, TileWithoutASeam) {
    const auto textures = draw_stage_textures(1);
    for (const StageTexture texture :
         {StageTexture::carpet, StageTexture::checker, StageTexture::brick, StageTexture::plaster,
          StageTexture::plaid, StageTexture::flowers, StageTexture::denim, StageTexture::tiles,
          StageTexture::metal, StageTexture::speckle}) {
        const ColourImage& t = textures[static_cast<std::size_t>(texture)];
        const int last = t.cols - 1;
        double ordinary = 0;
        for (int x = 0; x < last; ++x)
            ordinary = std::max(ordinary, cv::norm(t.col(x), t.col(x + 1), cv::NORM_L1));
        EXPECT_LE(cv::norm(t.col(last), t.col(0), cv::NORM_L1), 1.05 * ordinary)
            << static_cast<int>(texture);
    }
}

TEST(StageTextures, HaveDetailAtEveryScale) {
    const auto textures = draw_stage_textures(1);
    for (const StageTexture texture :
         {StageTexture::wood, StageTexture::carpet, StageTexture::brick, StageTexture::flowers,
          StageTexture::poster_skyline}) {
        cv::Mat level;
        cv::extractChannel(textures[static_cast<std::size_t>(texture)], level, 1);
        for (int scale = 1; scale <= 16; scale *= 2) {
            cv::Mat smaller, back;
            cv::resize(level, smaller, {}, 0.5, 0.5, cv::INTER_AREA);
            cv::resize(smaller, back, level.size(), 0, 0, cv::INTER_LINEAR);
            const double detail = cv::norm(level, back, cv::NORM_L2) / std::sqrt(level.total());
            EXPECT_GT(detail, 1.5) << "layer " << static_cast<int>(texture) << " scale " << scale;
            level = smaller;
        }
    }
}

}  // namespace
}  // namespace vantage
