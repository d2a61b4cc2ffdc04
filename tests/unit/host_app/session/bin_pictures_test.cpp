#include "host_app/desk/feed/bin_pictures.h"

#include <gtest/gtest.h>

#include "common/gl/context/egl_context.h"

namespace vantage {
namespace {

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
