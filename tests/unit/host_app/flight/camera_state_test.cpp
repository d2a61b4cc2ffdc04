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

}  // namespace
}  // namespace vantage
