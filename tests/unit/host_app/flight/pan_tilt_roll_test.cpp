#include <gtest/gtest.h>

#include "host_app/flight/orbit_view.h"
#include "tests/unit/host_app/flight/looking.h"

namespace vantage {
namespace {

TEST(PanTiltRoll, SurvivesARoundTripEvenStraightUpAndDown) {
    for (const double tilt : {-90.0, -89.0, -20.0, 0.0, 45.0, 90.0})
        for (const double pan : {-170.0, 0.0, 35.0})
            for (const double roll : {-60.0, 0.0, 10.0}) {
                Pose pose = Pose::Identity();
                pose.linear() = turned({pan * deg, tilt * deg, roll * deg});
                EXPECT_NEAR(pose.linear().determinant(), 1, 1e-12);
                EXPECT_TRUE(turned(pan_tilt_roll_of(pose)).isApprox(pose.linear(), 1e-6))
                    << pan << ", " << tilt << ", " << roll;
            }
}

TEST(OrbitViewOfACamera, IsThatCamera) {
    for (const double tilt : {-90.0, -30.0, 0.0, 60.0})
        for (const double roll : {-40.0, 0.0, 15.0}) {
            CameraState camera;
            camera.world_from_camera.linear() = turned({25 * deg, tilt * deg, roll * deg});
            camera.world_from_camera.translation() = Eigen::Vector3d(1, 1.6, -2);
            camera.focus_m = 3;
            camera.field_of_view_rad = 0.6;
            const CameraState again = orbit_view_of(camera, 7).camera();
            EXPECT_TRUE(again.world_from_camera.isApprox(camera.world_from_camera, 1e-6)) << tilt;
            EXPECT_EQ(again.focus_m, 3);
            EXPECT_EQ(again.field_of_view_rad, 0.6);
        }
}

TEST(OrbitViewOfACamera, TakenOverKeepsThePictureWithAPivotAboveTheFloor) {
    CameraState camera;
    camera.world_from_camera.linear() = turned({25 * deg, -30 * deg, 0});
    camera.world_from_camera.translation() = Eigen::Vector3d(1, 1.6, -2);
    camera.focus_m = 20;
    const FlightLimits limits;
    const OrbitView view = taken_over(camera, limits);
    EXPECT_NEAR(view.pivot_m.y(), limits.min_eye_height_m, 1e-9);
    EXPECT_TRUE(view.world_from_camera().isApprox(camera.world_from_camera, 1e-9));
}

}  // namespace
}  // namespace vantage
