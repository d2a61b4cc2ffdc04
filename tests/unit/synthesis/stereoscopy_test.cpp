#include "host_app/synthesis/stereoscopy.h"

#include <numbers>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "common/gl/egl_context.h"
#include "common/virtual_stage/virtual_rig.h"
#include "common/virtual_stage/virtual_stage.h"
#include "host_app/view_sets/image_metrics.h"
#include "tests/support/thrown_sentence.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;

constexpr auto stage_time = 2s;

StageCamera camera_at(double azimuth_deg, int width_px, int height_px) {
    const StereoCalibration rig =
        ideal_virtual_rig({.azimuth_rad = azimuth_deg * std::numbers::pi / 180,
                           .width_px = width_px,
                           .height_px = height_px});
    return {width_px, height_px, rig.left.K(), rig.world_from_left};
}

DepthView film(VirtualStage& stage, const StageCamera& camera) {
    StageRendering seen = stage.render(camera, stage_time);
    return {.name = "at " + std::to_string(camera.world_from_camera.translation().x()),
            .colour = seen.colour,
            .K = camera.K,
            .world_from_camera = camera.world_from_camera,
            .depth_m = seen.depth_m};
}

VirtualView plain_view(int width_px = 640) {
    VirtualView view{width_px, 240, Eigen::Matrix3d::Identity(), Pose::Identity()};
    view.K << 400, 0, 319.5, 0, 400, 119.5, 0, 0, 1;
    view.world_from_camera = look_at({1, 2, 3}, {0, 1, 0});
    return view;
}

double x_in(const VirtualView& eye, const Eigen::Vector3d& world) {
    return (eye.K * (eye.world_from_camera.inverse() * world)).hnormalized().x();
}

TEST(EyeViews, MeetAtTheConvergenceDistanceAndPartBeforeAndBehind) {
    const VirtualView view = plain_view();
    const Stereoscopy eyes{.interaxial_m = 0.1, .convergence_m = 3};
    const auto [left, right] = eye_views(view, eyes);
    EXPECT_EQ(left.width_px, 320);
    EXPECT_EQ(right.height_px, 240);
    for (const double z : {1.5, 3.0, 12.0}) {
        const Eigen::Vector3d point = view.world_from_camera * Eigen::Vector3d(0.2, -0.1, z);
        const double parallax_px = x_in(right, point) - x_in(left, point);
        EXPECT_NEAR(parallax_px, 0.5 * 400 * 0.1 * (1 / 3.0 - 1 / z), 1e-9) << z;
        if (z == 3.0) {
            // Column pairs become one: pixel centres of a half lie between those of the whole.
            EXPECT_NEAR(x_in(left, point), 0.5 * (x_in(view, point) + 0.5) - 0.5, 1e-9);
        }
    }
}

TEST(Stereoscopy, KeepsTheParallaxOfTheDistanceAtTwoPerCentByDefault) {
    VirtualView view = plain_view();
    for (const double f_px : {300.0, 1500.0})
        for (const double focus_m : {0.5, 8.0}) {
            view.K(0, 0) = f_px;
            const Stereoscopy eyes = Stereoscopy{}.settled(view, focus_m);
            EXPECT_EQ(eyes.convergence_m, focus_m);
            const auto [left, right] = eye_views(view, eyes);
            const Eigen::Vector3d far = view.world_from_camera * Eigen::Vector3d(0, 0, 1e9);
            EXPECT_NEAR(x_in(right, far) - x_in(left, far), 0.02 * 320, 1e-3);
        }
    const Stereoscopy asked = Stereoscopy{.interaxial_m = 0.3, .convergence_m = 7}.settled(view, 2);
    EXPECT_EQ(asked.interaxial_m, 0.3);
    EXPECT_EQ(asked.convergence_m, 7);
}

TEST(Stereoscopy, RefusesWhatHasNoTwoHalvesAndWhatConvergesNowhere) {
    EXPECT_NE(thrown_sentence([] {
                  (void)Stereoscopy{}.settled(plain_view(641), 3);
              }).find("take 640 or 642"),
              std::string::npos);
    EXPECT_NE(thrown_sentence([] {
                  (void)Stereoscopy{}.settled(plain_view(), 0);
              }).find("--convergence-m"),
              std::string::npos);
}

/// On the stage, with exact depth, surfaces lie as far apart in the halves as their depth says.
TEST(SideBySidePicture, ShowsThePointsOfTheStageWithTheirParallax) {
    const EglContext context;
    const ShaderLibrary shaders;
    VirtualStage stage(shaders);
    const DepthView views[] = {film(stage, camera_at(-4, 640, 240)),
                               film(stage, camera_at(4, 640, 240))};
    const StageCamera centre = camera_at(0, 640, 240);
    const DepthView truth = film(stage, centre);
    const VirtualView view{640, 240, centre.K, centre.world_from_camera};
    const double typical_m = typical_depth_m(views, view);
    EXPECT_GT(typical_m, 2);
    EXPECT_LT(typical_m, 12);
    const double convergence_m = 4.5, interaxial_m = 0.3;
    const auto [left, right] =
        eye_views(view, Stereoscopy{interaxial_m, convergence_m}.settled(view, typical_m));

    const auto synthesiser = make_synthesiser("mesh", shaders);
    synthesiser->set_views(views);
    SideBySide both;
    both.resize({640, 240});
    both.put_left(synthesiser->render(left));
    both.put_right(synthesiser->render(right));
    const ColourImage picture = both.picture().download();
    ASSERT_EQ(picture.size(), cv::Size(640, 240));
    cv::Mat grey, halves[2];
    cv::cvtColor(picture, grey, cv::COLOR_RGBA2GRAY);
    halves[0] = grey.colRange(0, 320);
    halves[1] = grey.colRange(320, 640);

    // Textured patches on one surface, looked for in the other half.
    constexpr int reach = 7, search = 14;
    std::vector<double> errors_px;
    int before_screen = 0, behind_screen = 0;
    for (int v = 20; v < 220; v += 6)
        for (int u = 60; u < 580; u += 9) {
            const cv::Rect around(u - 2 * reach, v - reach, 4 * reach + 1, 2 * reach + 1);
            double nearest_m = 0, farthest_m = 0;
            cv::minMaxLoc(truth.depth_m(around), &nearest_m, &farthest_m);
            if (farthest_m > 1.03 * nearest_m) continue;
            const double z = truth.depth_m(v, u);
            const double parallax_px =
                0.5 * centre.K(0, 0) * interaxial_m * (1 / convergence_m - 1 / z);
            // Where the left eye has it.
            const int x = cvRound(0.5 * (u + 0.5) - 0.5 - 0.5 * parallax_px);
            if (x - reach - search < 0 || x + reach + search >= 320) continue;
            const cv::Mat patch =
                halves[0](cv::Rect(x - reach, v - reach, 2 * reach + 1, 2 * reach + 1));
            cv::Scalar mean, deviation;
            cv::meanStdDev(patch, mean, deviation);
            if (deviation[0] < 12) continue;
            cv::Mat score;
            cv::matchTemplate(halves[1](cv::Rect(x - reach - search, v - reach,
                                                 2 * (reach + search) + 1, 2 * reach + 1)),
                              patch, score, cv::TM_CCOEFF_NORMED);
            cv::Point best;
            double likeness = 0;
            cv::minMaxLoc(score, nullptr, &likeness, nullptr, &best);
            if (likeness < 0.9) continue;
            errors_px.push_back(std::abs(best.x - search - parallax_px));
            before_screen += parallax_px < -2;
            behind_screen += parallax_px > 2;
        }
    EXPECT_GT(before_screen, 10);
    EXPECT_GT(behind_screen, 10);
    ASSERT_FALSE(errors_px.empty());
    std::sort(errors_px.begin(), errors_px.end());
    EXPECT_LT(errors_px[errors_px.size() / 2], 0.6) << errors_px.size() << " patches";
    EXPECT_LT(errors_px[errors_px.size() * 9 / 10], 1.5);
}

}  // namespace
}  // namespace vantage
