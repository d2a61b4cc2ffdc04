#include "host_app/flight/orbit_view.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/unit/host_app/flight/looking.h"

namespace vantage {
namespace {

constexpr double pi = std::numbers::pi;

TEST(OrbitView, AnglesGiveTheSideOfTheCamera) {
    OrbitView view;
    view.pivot_m = {1, 2, 3};
    view.distance_m = 2;
    EXPECT_TRUE(view.eye_m().isApprox(Eigen::Vector3d(1, 2, 5)));
    view.azimuth_rad = pi / 2;
    EXPECT_TRUE(view.eye_m().isApprox(Eigen::Vector3d(3, 2, 3)));
    view.elevation_rad = pi / 6;
    EXPECT_TRUE(view.eye_m().isApprox(Eigen::Vector3d(1 + std::sqrt(3.0), 3, 3)));
}

TEST(OrbitView, ShowsThePivotInTheMiddleAndWorldUpUpwards) {
    OrbitView view;
    view.azimuth_rad = 0.7;
    view.elevation_rad = 0.4;
    const Pose camera_from_world = view.world_from_camera().inverse();
    const Eigen::Matrix3d K = view.camera().K(101, 51);
    const auto project = [&](const Eigen::Vector3d& world) {
        return Eigen::Vector2d((K * (camera_from_world * world)).hnormalized());
    };
    EXPECT_TRUE(project(view.pivot_m).isApprox(Eigen::Vector2d(50, 25)));
    const Eigen::Vector2d above = project(view.pivot_m + Eigen::Vector3d(0, 0.1, 0));
    EXPECT_NEAR(above.x(), 50, 1e-9);
    EXPECT_LT(above.y(), 24);
}

TEST(OrbitView, FieldOfViewSpansTheWholeWidth) {
    OrbitView view;
    view.field_of_view_rad = 1.0;
    const Eigen::Matrix3d K = view.camera().K(640, 360);
    EXPECT_NEAR(2 * std::atan(320 / K(0, 0)), 1.0, 1e-12);
    EXPECT_EQ(K(0, 0), K(1, 1));
}

TEST(OrbitView, ComesBackFromItsEye) {
    OrbitView view;
    view.pivot_m = {0.3, 1.1, -0.4};
    view.azimuth_rad = 9.1;  // more than a turn
    view.elevation_rad = -0.2;
    view.distance_m = 3.3;
    const OrbitView back = view_from_eye(view.eye_m(), view.pivot_m, 0.6, 9.0);
    EXPECT_NEAR(back.azimuth_rad, view.azimuth_rad, 1e-12);
    EXPECT_NEAR(back.elevation_rad, view.elevation_rad, 1e-12);
    EXPECT_NEAR(back.distance_m, view.distance_m, 1e-12);
    EXPECT_EQ(back.field_of_view_rad, 0.6);
}

TEST(Constrained, NeverGoesThroughTheFloor) {
    const FlightLimits limits;
    for (const double distance : {0.5, 2.0, 20.0})
        for (const double height : {-1.0, 0.1, 1.0, 3.0}) {
            OrbitView view;
            view.pivot_m.y() = height;
            view.elevation_rad = -1.2;
            view.distance_m = distance;
            EXPECT_GE(constrained(view, limits).eye_m().y(), limits.min_eye_height_m - 1e-12)
                << distance << " m from a pivot at " << height << " m";
        }
}

TEST(Constrained, LeavesAnAllowedViewAsItIs) {
    OrbitView view;
    view.elevation_rad = 0.3;
    view.azimuth_rad = 12;
    const OrbitView same = constrained(view, {});
    EXPECT_EQ(same.eye_m(), view.eye_m());
    EXPECT_EQ(same.azimuth_rad, 12);
}

TEST(Constrained, ClampsDistanceFieldOfViewAndZenith) {
    const FlightLimits limits;
    OrbitView view;
    view.distance_m = 0;
    view.field_of_view_rad = 3;
    view.elevation_rad = 1.57;
    const OrbitView allowed = constrained(view, limits);
    EXPECT_EQ(allowed.distance_m, limits.min_distance_m);
    EXPECT_EQ(allowed.field_of_view_rad, limits.max_field_of_view_rad);
    EXPECT_EQ(allowed.elevation_rad, limits.max_elevation_rad);
}

TEST(NearestTurn, StaysWithinHalfATurn) {
    EXPECT_NEAR(nearest_turn(0.1, 4 * pi), 4 * pi + 0.1, 1e-12);
    EXPECT_NEAR(nearest_turn(3.0, -3.0), 3.0 - 2 * pi, 1e-12);
    EXPECT_EQ(nearest_turn(1.0, 0.5), 1.0);
}

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
