#include "host_app/flight/camera_state.h"

#include <cmath>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "tests/unit/host_app/flight/looking.h"

namespace vantage {
namespace {

CameraState turned_camera(CameraState camera, double angle_rad) {
    camera.world_from_camera.rotate(Eigen::AngleAxisd(angle_rad, Eigen::Vector3d::UnitY()));
    return camera;
}

TEST(CameraState, FieldOfViewSpansTheWidthOfAnyFrame) {
    const CameraState camera{.field_of_view_rad = 60 * deg};
    for (const int width_px : {64, 1280, 1921}) {
        const Eigen::Matrix3d K = camera.K(width_px, 720);
        EXPECT_NEAR(2 * std::atan(0.5 * width_px / K(0, 0)), 60 * deg, 1e-12);
        EXPECT_EQ(K(0, 0), K(1, 1)) << "pixels are square";
        EXPECT_EQ(K(0, 2), 0.5 * (width_px - 1)) << "pixel centres are whole numbers";
        EXPECT_EQ(K(1, 2), 359.5);
    }
}

TEST(CameraState, IsTheSameViewAsItself) {
    // Rounding must not give an angle between a rotation and itself.
    CameraState camera;
    for (int i = 0; i < 200; ++i) {
        camera = turned_camera(camera, 0.1 * i);
        EXPECT_TRUE(is_same_view(camera, camera)) << i;
    }
}

TEST(CameraState, IsTheSameViewUpToLessThanAPixel) {
    const CameraState camera{.world_from_camera = Pose::Identity(), .field_of_view_rad = 45 * deg};
    const double pixel_rad = camera.field_of_view_rad / 1920;
    EXPECT_TRUE(is_same_view(camera, turned_camera(camera, 0.02 * pixel_rad)));
    EXPECT_FALSE(is_same_view(camera, turned_camera(camera, pixel_rad)));
    EXPECT_FALSE(is_same_view(camera, turned_camera(camera, -pixel_rad)));
    EXPECT_FALSE(is_same_view(camera, turned_camera(camera, 180 * deg)));

    CameraState zoomed = camera;
    zoomed.field_of_view_rad += pixel_rad;
    EXPECT_FALSE(is_same_view(camera, zoomed));

    for (const Eigen::Vector3d& axis :
         {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 1, 0), Eigen::Vector3d(0, 0, 1)}) {
        CameraState moved = camera;
        moved.world_from_camera.pretranslate(camera.focus_m * pixel_rad * axis);
        EXPECT_FALSE(is_same_view(camera, moved));
        moved = camera;
        moved.world_from_camera.pretranslate(0.02 * camera.focus_m * pixel_rad * axis);
        EXPECT_TRUE(is_same_view(camera, moved));
    }
}

constexpr double tick_s = 0.04;

/// A camera on a dolly along x that pans.
CameraState at(double x_m, double pan_rad) {
    CameraState camera;
    camera.world_from_camera.translation() = Eigen::Vector3d(x_m, 1.5, 4);
    camera.world_from_camera.linear() =
        Eigen::AngleAxisd(pan_rad, Eigen::Vector3d::UnitY()).toRotationMatrix();
    return camera;
}

TEST(CameraForecast, KeepsACameraThatStands) {
    CameraForecast forecast;
    forecast.see(at(1, 0.2), 10);
    EXPECT_TRUE(is_same_view(forecast.in(0.5), at(1, 0.2))) << "one sample has no speed";
    for (int i = 1; i < 10; ++i) forecast.see(at(1, 0.2), 10 + i * tick_s);
    EXPECT_TRUE(is_same_view(forecast.in(0.5), at(1, 0.2)));
}

TEST(CameraForecast, ExtrapolatesMotionAndTurn) {
    CameraForecast forecast;
    // 2 m/s and 0.5 rad/s.
    for (int i = 0; i <= 10; ++i) forecast.see(at(2 * i * tick_s, 0.5 * i * tick_s), i * tick_s);
    EXPECT_TRUE(is_same_view(forecast.in(0), at(0.8, 0.2)));
    EXPECT_TRUE(is_same_view(forecast.in(0.5), at(1.8, 0.45)));
    EXPECT_TRUE(is_same_view(forecast.in(30), at(2.8, 0.7))) << "at most 1 s ahead";
}

TEST(CameraForecast, FollowsACameraThatStops) {
    CameraForecast forecast;
    int i = 0;
    for (; i <= 10; ++i) forecast.see(at(2 * i * tick_s, 0), i * tick_s);
    for (; i <= 15; ++i) forecast.see(at(0.8, 0), i * tick_s);
    EXPECT_TRUE(is_same_view(forecast.in(0.5), at(0.8, 0)));
}

TEST(CameraForecast, StartsAgainAfterACut) {
    CameraForecast forecast;
    forecast.see(at(0, 0), 0);
    forecast.see(at(3, 0), tick_s);
    EXPECT_TRUE(is_same_view(forecast.in(0.5), at(3, 0)));
    forecast.see(at(3, 3), 2 * tick_s);
    EXPECT_TRUE(is_same_view(forecast.in(0.5), at(3, 3)));
}

}  // namespace

}  // namespace vantage
