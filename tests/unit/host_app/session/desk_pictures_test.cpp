#include "host_app/desk/feed/desk_pictures.h"

#include <gtest/gtest.h>

#include "common/gl/context/egl_context.h"

namespace vantage {
namespace {

/// Depths from 2 m at the left to 8 m at the right.
DepthImage ramp() {
    DepthImage depth(4, 101);
    for (int y = 0; y < depth.rows; ++y)
        for (int x = 0; x < depth.cols; ++x) depth(y, x) = 2 + 0.06f * static_cast<float>(x);
    return depth;
}
int brightness(const cv::Vec4b& c) { return c[0] + c[1] + c[2]; }

TEST(DepthColoursTest, UseTheWholeRangeOfTheScene) {
    DepthRange range;
    range.follow(ramp());
    EXPECT_NEAR(range.nearest_m, 2.12, 0.07);
    EXPECT_NEAR(range.farthest_m, 7.88, 0.07);
    const ColourImage picture = depth_colours(ramp(), range);
    EXPECT_GT(brightness(picture(0, 0)), 500) << "the nearest is bright";
    EXPECT_LT(brightness(picture(0, 100)), 160) << "the farthest is dark";
    for (int x = 10; x <= 90; x += 10)
        EXPECT_LT(brightness(picture(0, x)), brightness(picture(0, x - 10))) << x;
}

TEST(DepthColoursTest, UnknownDepthsAreBlackAndOutsideTheRange) {
    DepthImage depth = ramp();
    depth.row(0).setTo(0);
    DepthRange range;
    range.follow(depth);
    EXPECT_NEAR(range.nearest_m, 2.12, 0.07);
    EXPECT_EQ(depth_colours(depth, range)(0, 50), cv::Vec4b(0, 0, 0, 255));
}

TEST(DepthColoursTest, AFewWildPixelsDoNotWidenTheRange) {
    DepthImage depth = ramp();
    depth(0, 0) = 0.01f;
    depth(1, 1) = 900;
    DepthRange range;
    range.follow(depth);
    EXPECT_GT(range.nearest_m, 2);
    EXPECT_LT(range.farthest_m, 8);
}

TEST(DepthColoursTest, TheRangeFollowsSlowly) {
    DepthRange range;
    range.follow(DepthImage(4, 4, 2.0f));
    range.follow(DepthImage(4, 4, 4.0f));
    EXPECT_GT(range.nearest_m, 2.0);
    EXPECT_LT(range.nearest_m, 2.5);
    for (int i = 0; i < 100; ++i) range.follow(DepthImage(4, 4, 4.0f));
    EXPECT_NEAR(range.nearest_m, 4, 0.01);
    const DepthRange before = range;
    range.follow(DepthImage(4, 4, 0.0f));
    EXPECT_EQ(range.nearest_m, before.nearest_m) << "a frame without depth changes nothing";
}

TEST(DepthColoursTest, DepthUsesTheWidthOfTheDisparityImage) {
    RectifiedStereo geometry;
    geometry.f_px = 100;
    geometry.baseline_m = 0.2;
    geometry.width_px = 2;
    const DisparityScale scale(geometry, 2);
    const DisparityImage disparity(1, 2, static_cast<unsigned short>(5 * disparity_steps_per_px));
    EXPECT_NEAR(depth_of(disparity, scale)(0, 0), 4, 1e-5);
    EXPECT_EQ(depth_of(DisparityImage::zeros(1, 2), scale)(0, 1), 0);
}

using namespace std::chrono_literals;

class ShotPicturesTest : public testing::Test {
  protected:
    MadePicture made(const OrbitView& view, uchar red) const {
        MadePicture picture;
        picture.job.camera = view.camera();
        picture.picture = ColourImage(180, 320, cv::Vec4b(red, 0, 0, 255));
        return picture;
    }
    static uchar red_of(const Texture& texture) { return ColourImage(texture.download())(0, 0)[0]; }
    static Shot shot_aside() {
        Shot shot;
        shot.view = aside();
        return shot;
    }
    static OrbitView aside() {
        OrbitView view;
        view.azimuth_rad = 0.4;
        return view;
    }

    EglContext context_;
    ShotPictures pictures_;
    FlightControls::Shots shots_;
    MonotonicTime start_{1h};
};

TEST_F(ShotPicturesTest, ShowTheProgrammesPictureAtTheShot) {
    shots_[3] = Shot{};
    pictures_.follow(shots_, made(aside(), 50), start_);
    EXPECT_EQ(pictures_.of(4), nullptr) << "the camera was not there yet";
    pictures_.follow(shots_, made(OrbitView{}, 90), start_);
    ASSERT_NE(pictures_.of(4), nullptr);
    EXPECT_EQ(red_of(*pictures_.of(4)), 90);
    EXPECT_LT(pictures_.of(4)->width_px(), 320);
    EXPECT_EQ(pictures_.of(1), nullptr);
    pictures_.follow(shots_, made(aside(), 50), start_ + 10s);
    EXPECT_EQ(red_of(*pictures_.of(4)), 90) << "elsewhere it stays";
}

TEST_F(ShotPicturesTest, AreRenewedWhileTheCameraStaysAtTheShot) {
    shots_[0] = Shot{};
    pictures_.follow(shots_, made(OrbitView{}, 90), start_);
    pictures_.follow(shots_, made(OrbitView{}, 91), start_ + 100ms);
    EXPECT_EQ(red_of(*pictures_.of(1)), 90);
    pictures_.follow(shots_, made(OrbitView{}, 92), start_ + 3s);
    EXPECT_EQ(red_of(*pictures_.of(1)), 92);
}

TEST_F(ShotPicturesTest, EndWithTheirShot) {
    shots_[0] = Shot{};
    pictures_.follow(shots_, made(OrbitView{}, 90), start_);
    shots_[0] = shot_aside();
    pictures_.follow(shots_, made(OrbitView{}, 91), start_ + 3s);
    EXPECT_EQ(pictures_.of(1), nullptr) << "another view is stored there now";
}

}  // namespace

}  // namespace vantage
