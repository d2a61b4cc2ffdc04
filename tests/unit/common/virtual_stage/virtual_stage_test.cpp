#include "common/virtual_stage/virtual_stage.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include <GLES3/gl31.h>
#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/gl/context/egl_context.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;
using Eigen::Vector3d;

StageCamera camera_at(const Vector3d& eye_m, const Vector3d& target_m, cv::Size size,
                      double focal_px) {
    StageCamera camera;
    camera.width_px = size.width;
    camera.height_px = size.height;
    camera.K << focal_px, 0, 0.5 * (size.width - 1), 0, focal_px, 0.5 * (size.height - 1), 0, 0, 1;
    camera.world_from_camera = look_at(eye_m, target_m);
    return camera;
}

class VirtualStageTest : public testing::Test {
  protected:
    EglContext context_;
    ShaderLibrary library_;
};

/// Depth of the floor y = 0 along the ray through a pixel, from the definition of K.
double floor_depth_m(const StageCamera& camera, int x, int y) {
    const Vector3d ray = camera.K.inverse() * Vector3d(x, y, 1);
    const double fall = (camera.world_from_camera.linear() * ray).y();
    return -camera.world_from_camera.translation().y() / fall;
}

TEST_F(VirtualStageTest, DepthOfTheBareFloorIsExactForAnyK) {
    VirtualStage stage(library_);
    // A bare part of the floor, seen at a slant.
    StageCamera camera = camera_at({-0.3, 1.5, 5.6}, {-0.2, 0, 4.9}, {101, 77}, 120);
    const auto worst_error = [&] {
        const DepthImage depth_m = stage.render(camera, 1s).depth_m;
        double worst = 0;
        for (int y = 0; y < depth_m.rows; ++y)
            for (int x = 0; x < depth_m.cols; ++x)
                worst = std::max(worst, std::abs(depth_m(y, x) / floor_depth_m(camera, x, y) - 1));
        return worst;
    };
    EXPECT_LT(worst_error(), 2e-5);
    camera.K(0, 1) = 17.5;  // skew
    EXPECT_LT(worst_error(), 2e-5);
    camera.K(0, 0) = 171;
    camera.K(0, 2) = 31.25;
    camera.K(1, 2) = 51.75;
    EXPECT_LT(worst_error(), 2e-5);
}

/// Of A's pixels: the share whose surface B sees; of these, the share that lies between B's depths
/// at the four pixels around, and the share that stands before all of B's surface (slips between
/// B's pixels).
struct Agreement {
    double seen = 0, agreeing = 0, before = 0;
};
Agreement agreement(const StageCamera& a, const DepthImage& depth_a, const StageCamera& b,
                    const DepthImage& depth_b) {
    int seen = 0, agreeing = 0, before = 0;
    const Pose b_from_a = b.world_from_camera.inverse() * a.world_from_camera;
    for (int y = 0; y < depth_a.rows; ++y)
        for (int x = 0; x < depth_a.cols; ++x) {
            const Vector3d point = b_from_a * (a.K.inverse() * Vector3d(x, y, 1) * depth_a(y, x));
            if (point.z() <= 0.1) continue;
            const Vector3d pixel = b.K * point / point.z();
            const int u = static_cast<int>(std::floor(pixel.x())),
                      v = static_cast<int>(std::floor(pixel.y()));
            if (u < 0 || v < 0 || u + 1 >= depth_b.cols || v + 1 >= depth_b.rows) continue;
            const float z[4] = {depth_b(v, u), depth_b(v, u + 1), depth_b(v + 1, u),
                                depth_b(v + 1, u + 1)};
            const auto [nearest, farthest] = std::minmax_element(z, z + 4);
            // Across an edge nothing can be said, and what is behind B's surface B does not see.
            if (*farthest > 1.02f * *nearest || point.z() > 1.01 * *farthest) continue;
            ++seen;
            if (point.z() > 0.999 * *nearest && point.z() < 1.001 * *farthest) ++agreeing;
            if (point.z() < 0.99 * *nearest) ++before;
        }
    return {static_cast<double>(seen) / static_cast<double>(depth_a.total()),
            static_cast<double>(agreeing) / seen, static_cast<double>(before) / seen};
}

TEST_F(VirtualStageTest, TwoViewsAgreeOnEveryPointBothSee) {
    for (const std::uint64_t scene : {0, 1, 2}) {
        VirtualStage stage(library_, scene);
        const StageCamera a = camera_at({1.2, 1.7, 4.3}, {0, 1, 0}, {160, 120}, 150);
        const StageCamera b = camera_at({-0.4, 2.0, 4.5}, {0.1, 0.9, 0}, {161, 119}, 165);
        const Agreement found =
            agreement(a, stage.render(a, 2500ms).depth_m, b, stage.render(b, 2500ms).depth_m);
        EXPECT_GT(found.seen, 0.3) << "scene " << scene;
        EXPECT_GT(found.agreeing + found.before, 0.99) << "scene " << scene;
        EXPECT_LT(found.before, 0.04) << "scene " << scene;
    }
}

TEST_F(VirtualStageTest, SurroundsItsCamerasWithColourAndDepth) {
    VirtualStage stage(library_);
    for (int i = 0; i < 8; ++i) {
        const double azimuth = 0.7854 * i, elevation = -0.1 + 0.2 * i;
        const Vector3d eye =
            Vector3d(0, 1, 0) + 3.9 * Vector3d(std::cos(elevation) * std::sin(azimuth),
                                               std::sin(elevation),
                                               std::cos(elevation) * std::cos(azimuth));
        const StageRendering r =
            stage.render(camera_at(eye, {0, 1, 0}, {61, 47}, 30), std::chrono::seconds(i));
        double nearest = 0, farthest = 0;
        cv::minMaxLoc(r.depth_m, &nearest, &farthest);
        EXPECT_GT(nearest, 0.1);
        EXPECT_LT(farthest, 13) << "no ray leaves the room";
        int black = 0;
        for (const cv::Vec4b& c : r.colour) {
            black += c[0] + c[1] + c[2] < 12;
            ASSERT_EQ(c[3], 255);
        }
        EXPECT_LT(black, static_cast<int>(r.colour.total()) / 50);
    }
}

TEST_F(VirtualStageTest, TheSameTimeGivesTheSamePixels) {
    VirtualStage stage(library_), other(library_);
    const StageCamera camera = camera_at({1, 1.6, 4}, {0, 1, 0}, {121, 91}, 110);
    const StageRendering first = stage.render(camera, 1700ms);
    const StageRendering later = stage.render(camera, 4200ms);
    const StageRendering again = stage.render(camera, 1700ms);
    const StageRendering elsewhere = other.render(camera, 1700ms);
    EXPECT_EQ(cv::norm(first.colour, again.colour, cv::NORM_INF), 0);
    EXPECT_EQ(cv::norm(first.depth_m, again.depth_m, cv::NORM_INF), 0);
    EXPECT_EQ(cv::norm(first.colour, elsewhere.colour, cv::NORM_INF), 0);
    EXPECT_EQ(cv::norm(first.depth_m, elsewhere.depth_m, cv::NORM_INF), 0);
    cv::Mat moved;
    cv::absdiff(first.depth_m, later.depth_m, moved);
    EXPECT_GT(cv::countNonZero(moved > 0.05f), 100) << "the performers move";
}

TEST_F(VirtualStageTest, AStationaryCameraSeesTheSameImages) {
    for (const std::uint64_t scene : {0, 3}) {
        VirtualStage stage(library_, scene);
        // Six, of which four are kept; the last stands among the performers.
        const Vector3d eyes[] = {{-2.2, 1.8, 3.8}, {0, 1.8, 4.4}, {2.2, 1.2, 3.8},
                                 {-3, 3.2, 2},     {0, 1, -4.2},  {0.3, 1.2, 1.9}};
        int shadowed = 0;
        for (int i = 0; i < 14; ++i) {
            StageCamera camera = camera_at(eyes[i % 6], {0, 0.9, 0}, {121, 91}, 110);
            camera.K(0, 1) = i % 6;
            const auto time = i * 1730ms;
            const StageOptions still{.anti_aliased = i % 3 != 0, .stands_still = true};
            StageOptions free = still;
            free.stands_still = false;
            // A second instant of it is drawn over the cached scenery.
            (void)stage.render(camera, time + 700ms, still);
            const StageRendering kept = stage.render(camera, time, still),
                                 drawn = stage.render(camera, time, free);
            EXPECT_EQ(cv::norm(kept.depth_m, drawn.depth_m, cv::NORM_INF), 0);
            EXPECT_EQ(cv::norm(kept.colour, drawn.colour, cv::NORM_INF), 0)
                << "scene " << scene << ", picture " << i;
            const StageRendering later = stage.render(camera, time + 700ms, free);
            for (int y = 0; y < 91; ++y)
                for (int x = 0; x < 121; ++x)
                    shadowed += later.depth_m(y, x) == drawn.depth_m(y, x) &&
                                later.colour(y, x) != drawn.colour(y, x);
        }
        EXPECT_GT(shadowed, 5000) << "shadows move over what stands still";
    }
}

TEST_F(VirtualStageTest, EverySeedIsAnotherScene) {
    const StageCamera camera = camera_at({1, 1.6, 4}, {0, 1, 0}, {61, 47}, 50);
    const StageRendering a = VirtualStage(library_, 11).render(camera, 1s);
    const StageRendering same = VirtualStage(library_, 11).render(camera, 1s);
    const StageRendering b = VirtualStage(library_, 12).render(camera, 1s);
    EXPECT_EQ(cv::norm(a.colour, same.colour, cv::NORM_INF), 0);
    EXPECT_GT(cv::norm(a.colour, b.colour, cv::NORM_L1) / (3.0 * a.colour.total()), 10);
    EXPECT_GT(cv::norm(a.depth_m, b.depth_m, cv::NORM_L1) / a.depth_m.total(), 0.1);
}

TEST_F(VirtualStageTest, AntiAliasingKeepsTheMeanAndSmoothsEdges) {
    VirtualStage stage(library_);
    const StageCamera camera = camera_at({1, 1.6, 4}, {0, 1, 0}, {121, 91}, 110);
    const auto picture = [&](bool anti_aliased) {
        return stage
            .render(camera, 1s, {.pictures = StagePictures::colour, .anti_aliased = anti_aliased})
            .colour;
    };
    const ColourImage smooth = picture(true), rough = picture(false);
    const cv::Scalar difference = cv::mean(smooth) - cv::mean(rough);
    for (int channel = 0; channel < 3; ++channel) EXPECT_LT(std::abs(difference[channel]), 2.5);
    const auto roughness = [](const ColourImage& image) {
        return cv::norm(image.rowRange(1, image.rows), image.rowRange(0, image.rows - 1),
                        cv::NORM_L2);
    };
    EXPECT_LT(roughness(smooth), 0.97 * roughness(rough));
}

TEST_F(VirtualStageTest, DrawsOnlyTheRequestedImages) {
    VirtualStage stage(library_);
    const StageCamera camera = camera_at({1, 1.6, 4}, {0, 1, 0}, {31, 23}, 30);
    const StageRendering depth = stage.render(camera, 1s, {.pictures = StagePictures::depth});
    EXPECT_TRUE(depth.colour.empty());
    EXPECT_EQ(depth.depth_m.size(), cv::Size(31, 23));
    const StageRendering colour = stage.render(camera, 1s, {.pictures = StagePictures::colour});
    EXPECT_TRUE(colour.depth_m.empty());
    EXPECT_EQ(colour.colour.size(), cv::Size(31, 23));
}

TEST_F(VirtualStageTest, RefusesInvalidCameras) {
    VirtualStage stage(library_);
    const StageCamera good = camera_at({1, 1.6, 4}, {0, 1, 0}, {31, 23}, 30);
    StageCamera bad = good;
    bad.K(0, 0) = 0;
    EXPECT_THROW(stage.render(bad, 1s), Error);
    bad = good;
    bad.K(2, 0) = 0.1;
    EXPECT_THROW(stage.render(bad, 1s), Error);
    bad = good;
    bad.width_px = 0;
    EXPECT_THROW(stage.render(bad, 1s), Error);
    bad = good;
    bad.height_px = 4097;
    EXPECT_THROW(stage.render(bad, 1s), Error);
    bad = good;
    bad.world_from_camera.translation().x() = NAN;
    EXPECT_THROW(stage.render(bad, 1s), Error);
    EXPECT_NO_THROW(stage.render(good, 1s)) << "and goes on afterwards";
}

TEST_F(VirtualStageTest, LeavesTheContextReadyForOtherPasses) {
    VirtualStage stage(library_);
    glViewport(1, 2, 3, 4);
    stage.render(camera_at({1, 1.6, 4}, {0, 1, 0}, {31, 23}, 30), 1s);
    GLint viewport[4] = {}, framebuffer = -1, winding = 0;
    glGetIntegerv(GL_VIEWPORT, viewport);
    glGetIntegerv(GL_FRAMEBUFFER_BINDING, &framebuffer);
    glGetIntegerv(GL_FRONT_FACE, &winding);
    EXPECT_EQ(viewport[3], 4);
    EXPECT_EQ(framebuffer, 0);
    EXPECT_EQ(winding, GL_CCW);
    EXPECT_FALSE(glIsEnabled(GL_DEPTH_TEST));
    EXPECT_FALSE(glIsEnabled(GL_CULL_FACE));
    EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
}

}  // namespace
}  // namespace vantage
