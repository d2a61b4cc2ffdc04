#include "host_app/synthesis/stereoscopy.h"

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "common/gl/context/egl_context.h"
#include "common/virtual_stage/virtual_stage.h"
#include "host_app/view_sets/image_metrics.h"
#include "tests/support/stage_camera_at.h"
#include "tests/support/thrown_sentence.h"

namespace vantage {
namespace {

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
    const std::vector<VirtualView> both = eye_views(view, eyes);
    const VirtualView &left = both[0], &right = both[1];
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
            const std::vector<VirtualView> both = eye_views(view, eyes);
            const VirtualView &left = both[0], &right = both[1];
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

TEST(Stereoscopy, AsksForWholeTilesOfAQuilt) {
    const Stereoscopy quilt{.layout = StereoLayout::quilt, .quilt = {5, 3}};
    EXPECT_NE(thrown_sentence([&] {
                  (void)quilt.settled(plain_view(641), 3);
              }).find("5 equal parts; 641 px is not, take 640 or 645"),
              std::string::npos);
    EXPECT_EQ(quilt.rendered_size({640, 240}, 0.625), cv::Size(400, 150));
    const Stereoscopy rows{.layout = StereoLayout::interleaved_rows};
    EXPECT_EQ(rows.rendered_size({640, 240}, 0.625), cv::Size(640, 240))
        << "rows that are enlarged are no eye's";
}

TEST(EyeViews, OfInterleavedRowsShowTheRowsOfTheWhole) {
    const VirtualView view = plain_view();
    const std::vector<VirtualView> eyes = eye_views(
        view, {.interaxial_m = 0.1, .convergence_m = 3, .layout = StereoLayout::interleaved_rows});
    for (int i = 0; i < 2; ++i) {
        const VirtualView& eye = eyes[static_cast<std::size_t>(i)];
        EXPECT_EQ(eye.height_px, 120);
        const Eigen::Vector3d at_screen = view.world_from_camera * Eigen::Vector3d(0.2, -0.1, 3);
        const auto row = [&](const VirtualView& one) {
            return (one.K * (one.world_from_camera.inverse() * at_screen)).hnormalized().y();
        };
        EXPECT_NEAR(2 * row(eye) + i, row(view), 1e-9);
    }
}

TEST(EyeViews, OfAQuiltGoFromLeftToRightInEvenSteps) {
    const VirtualView view = plain_view();
    const Stereoscopy quilt =
        Stereoscopy{.interaxial_m = 0.7, .layout = StereoLayout::quilt, .quilt = {4, 2}}.settled(
            view, 3);
    const std::vector<VirtualView> eyes = eye_views(view, quilt);
    ASSERT_EQ(eyes.size(), 8u);
    for (std::size_t i = 0; i < 8; ++i) {
        EXPECT_EQ(eyes[i].width_px, 160);
        EXPECT_EQ(eyes[i].height_px, 120);
        const Eigen::Vector3d at =
            view.world_from_camera.inverse() * eyes[i].world_from_camera.translation();
        EXPECT_NEAR(at.x(), -0.35 + 0.1 * static_cast<double>(i), 1e-9);
    }
}

/// The mosaic of eyes that each show one grey.
class EyeMosaicTest : public testing::Test {
  protected:
    ColourImage mosaic(const Stereoscopy& settled, cv::Size size, const cv::Vec4b& first,
                       int brighter) {
        EyeMosaic mosaic(shaders_);
        mosaic.begin(size, settled);
        const cv::Size by = settled.tiles();
        for (std::size_t i = 0; i < settled.eyes(); ++i) {
            Texture eye(TextureFormat::rgba8, size.width / by.width, size.height / by.height);
            cv::Vec4b grey = first;
            for (int c = 0; c < 3; ++c)
                grey[c] = static_cast<uchar>(grey[c] + brighter * static_cast<int>(i));
            eye.upload(ColourImage(eye.size(), grey));
            mosaic.put(eye, i);
        }
        return mosaic.picture().download();
    }

    EglContext context_;
    ShaderLibrary shaders_;
};

TEST_F(EyeMosaicTest, PutsEveryEyeWhereItsLayoutHasIt) {
    const cv::Vec4b dark(40, 40, 40, 255);
    const ColourImage beside = mosaic({.layout = StereoLayout::side_by_side}, {18, 6}, dark, 100);
    EXPECT_EQ(beside(3, 8)[0], 40);
    EXPECT_EQ(beside(3, 9)[0], 140);
    const ColourImage below = mosaic({.layout = StereoLayout::top_and_bottom}, {18, 6}, dark, 100);
    EXPECT_EQ(below(2, 17)[0], 40);
    EXPECT_EQ(below(3, 0)[0], 140);
    const ColourImage rows = mosaic({.layout = StereoLayout::interleaved_rows}, {18, 6}, dark, 100);
    for (int v = 0; v < 6; ++v) EXPECT_EQ(rows(v, 5)[0], v % 2 == 0 ? 40 : 140);
    const ColourImage quilt =
        mosaic({.layout = StereoLayout::quilt, .quilt = {3, 2}}, {18, 6}, dark, 30);
    EXPECT_EQ(quilt(5, 0)[0], 40) << "the leftmost view is at the lower left";
    EXPECT_EQ(quilt(5, 17)[0], 100);
    EXPECT_EQ(quilt(0, 0)[0], 130);
    EXPECT_EQ(quilt(0, 17)[0], 190);
}

TEST_F(EyeMosaicTest, LetsGlassesPartTheEyesOfAnAnaglyph) {
    const Stereoscopy anaglyph{.layout = StereoLayout::anaglyph};
    // White for one eye only.
    const ColourImage left = mosaic(anaglyph, {4, 4}, {255, 255, 255, 255}, -255);
    EXPECT_GT(left(1, 1)[0], 240);
    EXPECT_LT(left(1, 1)[1], 10);
    EXPECT_LT(left(1, 1)[2], 10);
    const ColourImage right = mosaic(anaglyph, {4, 4}, {0, 0, 0, 255}, 255);
    EXPECT_LT(right(1, 1)[0], 10);
    EXPECT_GT(right(1, 1)[1], 240);
    EXPECT_GT(right(1, 1)[2], 240);
    const ColourImage both = mosaic(anaglyph, {4, 4}, {255, 255, 255, 255}, 0);
    for (int c = 0; c < 3; ++c) EXPECT_GT(both(1, 1)[c], 240);
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
    const Stereoscopy settled = Stereoscopy{interaxial_m, convergence_m}.settled(view, typical_m);
    const std::vector<VirtualView> eyes = eye_views(view, settled);

    const auto synthesiser = make_synthesiser("mesh", shaders);
    synthesiser->set_views(views);
    EyeMosaic both(shaders);
    both.begin({640, 240}, settled);
    for (std::size_t i = 0; i < 2; ++i) both.put(synthesiser->render(eyes[i]), i);
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
