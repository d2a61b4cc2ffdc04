#include "host_app/flight/camera_forecast.h"

#include <gtest/gtest.h>

namespace vantage {
namespace {

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
