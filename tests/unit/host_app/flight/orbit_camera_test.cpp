#include "host_app/flight/orbit_camera.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/unit/host_app/flight/looking.h"
#include "tests/unit/host_app/flight/ring_of_rigs.h"

namespace vantage {
namespace {

void settle(OrbitCamera& camera) {
    for (int i = 0; i < 1000; ++i) camera.advance(0.02);
}

TEST(OrbitCamera, SettlesOnItsGoal) {
    OrbitCamera camera{OrbitView()};
    camera.orbit(1.0, 0.5);
    camera.dolly(0.4);
    settle(camera);
    EXPECT_NEAR(camera.view().azimuth_rad, 1.0, 1e-9);
    EXPECT_NEAR(camera.view().elevation_rad, 0.5, 1e-9);
    EXPECT_NEAR(camera.view().distance_m, 4.5 * std::exp(-0.4), 1e-9);
}

TEST(OrbitCamera, PanOfOneWidthMovesThePivotAcrossThePicture) {
    OrbitView start;
    start.azimuth_rad = 0.5;
    start.elevation_rad = 0.3;
    OrbitCamera camera{start};
    camera.pan(1, 0);
    settle(camera);
    // The old pivot has moved from the middle of the picture to half a picture beyond its left
    // edge.
    const OrbitView& view = camera.view();
    const Eigen::Vector3d old_pivot = view.world_from_camera().inverse() * start.pivot_m;
    const double half_width = std::tan(0.5 * view.field_of_view_rad);
    EXPECT_NEAR(old_pivot.x() / old_pivot.z(), -2 * half_width, 1e-9);
    EXPECT_NEAR(old_pivot.y(), 0, 1e-9);
}

TEST(OrbitCamera, TurnsNoFasterThanTheLimit) {
    const FlightLimits limits;
    OrbitCamera camera{OrbitView()};
    camera.orbit(20, 0);
    for (int i = 0; i < 50; ++i) {
        const double before = camera.view().azimuth_rad;
        camera.advance(0.04);
        EXPECT_LE(camera.view().azimuth_rad - before, limits.max_turn_rad_s * 0.04 + 1e-12);
    }
    EXPECT_NEAR(camera.view().azimuth_rad,
                (50 * 0.04 - 0.5 * limits.ramp_s) * limits.max_turn_rad_s,
                0.02 * limits.max_turn_rad_s)
        << "except for its ramp";
}

TEST(OrbitCamera, SpeedChangesNoFasterThanItsRamp) {
    for (const double ramp_s : {0.1, 0.5, 2.0}) {
        FlightLimits limits;
        limits.ramp_s = ramp_s;
        OrbitCamera camera{OrbitView(), limits};
        camera.orbit(2, 0);
        double last_rad_s = 0, before = 0, highest = 0;
        for (int i = 0; i < 800; ++i) {
            camera.advance(0.01);
            const double rad_s = (camera.view().azimuth_rad - before) / 0.01;
            EXPECT_LE(std::abs(rad_s - last_rad_s), limits.max_turn_rad_s / ramp_s * 0.01 * 1.2)
                << ramp_s << " s, step " << i;
            last_rad_s = rad_s;
            before = camera.view().azimuth_rad;
            highest = std::max(highest, before);
        }
        EXPECT_NEAR(before, 2, 1e-4) << ramp_s;
        EXPECT_LT(highest, 2.02) << "no overshoot with a ramp of " << ramp_s;
    }
}

TEST(OrbitCamera, FollowsWithItsTimeConstant) {
    const auto gone = [](double follow_s) {
        FlightLimits limits;
        limits.follow_s = follow_s;
        limits.ramp_s = 0;
        OrbitCamera camera{OrbitView(), limits};
        camera.orbit(0.1, 0);
        for (int i = 0; i < 20; ++i) camera.advance(0.01);
        return camera.view().azimuth_rad;
    };
    EXPECT_NEAR(gone(0.2), 0.1 * (1 - std::exp(-1)), 1e-4);
    EXPECT_GT(gone(0.05), gone(0.5));
}

TEST(OrbitCamera, CranesStraightUpAndLooksAroundInPlace) {
    OrbitView start;
    start.elevation_rad = 0.5;
    OrbitCamera camera{start};
    camera.crane(0.2);
    settle(camera);
    const Eigen::Vector3d way = camera.view().eye_m() - start.eye_m();
    EXPECT_NEAR(way.x(), 0, 1e-9);
    EXPECT_GT(way.y(), 0.3);
    EXPECT_NEAR(way.z(), 0, 1e-9);
    const OrbitView before = camera.view();
    camera.look(0.3, 0.1);
    settle(camera);
    EXPECT_TRUE(camera.view().eye_m().isApprox(before.eye_m(), 1e-6));
    const Eigen::Vector3d there = before.world_from_camera().inverse() * camera.view().pivot_m;
    EXPECT_GT(there.x(), 0.5) << "to the right";
    EXPECT_LT(there.y(), -0.1) << "up";
}

TEST(OrbitCamera, RollsAndLevelsTheShorterWay) {
    OrbitCamera camera{OrbitView()};
    camera.roll(6);
    settle(camera);
    EXPECT_NEAR(camera.view().roll_rad, 6, 1e-6);
    camera.level();
    settle(camera);
    EXPECT_NEAR(camera.view().roll_rad, 2 * M_PI, 1e-6);
}

TEST(OrbitCamera, MovesThePivotNoFasterThanTheLimit) {
    const FlightLimits limits;
    OrbitCamera camera{OrbitView()};
    OrbitView far;
    far.pivot_m = {20, 15, -20};
    camera.fly_to(far);
    Eigen::Vector3d before = camera.view().pivot_m;
    for (int i = 0; i < 20; ++i) {
        before = camera.view().pivot_m;
        camera.advance(0.1);
        EXPECT_LE((camera.view().pivot_m - before).norm(), 0.1 * limits.max_speed_m_s + 1e-9);
    }
    EXPECT_NEAR((camera.view().pivot_m - before).norm(), 0.1 * limits.max_speed_m_s, 1e-9);
}

TEST(OrbitCamera, StaysAboveTheFloorOnItsWay) {
    const FlightLimits limits;
    OrbitView start;
    start.pivot_m.y() = 5;
    start.elevation_rad = -0.5;
    OrbitCamera camera(start, limits);
    OrbitView low;
    low.pivot_m.y() = 0.1;
    low.distance_m = 12;
    camera.fly_to(low);
    for (int i = 0; i < 300; ++i) {
        camera.advance(0.02);
        EXPECT_GE(camera.view().eye_m().y(), limits.min_eye_height_m - 1e-12);
    }
}

TEST(OrbitCamera, FliesTheShorterWayRound) {
    OrbitView start;
    start.azimuth_rad = 3.0;
    OrbitCamera camera{start};
    OrbitView goal;
    goal.azimuth_rad = -3.0;
    camera.fly_to(goal);
    camera.advance(0.1);
    EXPECT_GT(camera.view().azimuth_rad, 3.0);
    settle(camera);
    EXPECT_NEAR(std::remainder(camera.view().azimuth_rad + 3.0, 2 * M_PI), 0, 1e-9);
}

TEST(OrbitCamera, StandsStillWhileNoTimePasses) {
    OrbitCamera camera{OrbitView()};
    camera.orbit(1, 0);
    camera.advance(0);
    EXPECT_EQ(camera.view().azimuth_rad, 0);
}

/// Turns a camera by steady wheel input, and returns the way of each step.
std::vector<double> steps_of_a_turning_hand(OrbitCamera& camera, int steps, double turn_deg) {
    std::vector<double> way_deg;
    for (int i = 0; i < steps; ++i) {
        camera.orbit(turn_deg * deg, 0);
        const double before_rad = camera.view().azimuth_rad;
        camera.advance(0.02);
        way_deg.push_back((camera.view().azimuth_rad - before_rad) / deg);
    }
    return way_deg;
}

TEST(OrbitCameraInACorridor, SlowsSmoothlyAndStopsAtTheEnd) {
    const auto corridor = corridor_of({-10, 10});
    OrbitCamera camera{view_at(0)};
    camera.keep_within(corridor);
    const std::vector<double> way_deg = steps_of_a_turning_hand(camera, 500, 0.5);
    for (std::size_t i = 20; i < way_deg.size(); ++i) {
        EXPECT_LT(way_deg[i], way_deg[i - 1] + 0.02) << "step " << i;
        EXPECT_GT(way_deg[i], way_deg[i - 1] - 0.1) << "step " << i << ": a jerk";
    }
    EXPECT_NEAR(way_deg.back(), 0, 0.01);
    const double share = corridor->of(camera.view().camera()).share;
    EXPECT_GE(share, Corridor::end);
    EXPECT_LT(share, Corridor::end + 0.05);
}

TEST(OrbitCameraInACorridor, ReturnsAtOnceWhenInputReverses) {
    OrbitCamera camera{view_at(0)};
    camera.keep_within(corridor_of({-10, 10}));
    steps_of_a_turning_hand(camera, 500, 2);
    const std::vector<double> back_deg = steps_of_a_turning_hand(camera, 10, -2);
    EXPECT_LT(back_deg.back(), -0.5);
}

TEST(OrbitCameraInACorridor, MovesFreelyAlongTheEnd) {
    OrbitCamera camera{view_at(0)};
    camera.keep_within(corridor_of({-10, 10}));
    steps_of_a_turning_hand(camera, 500, 0.5);
    const double before_rad = camera.view().field_of_view_rad;
    camera.zoom(0.3);
    settle(camera);
    EXPECT_NEAR(camera.view().field_of_view_rad, before_rad * std::exp(-0.3), 1e-6);
}

TEST(OrbitCameraInACorridor, DoesNotCrossTheEndInOneLongStep) {
    const auto corridor = corridor_of({-10, 10});
    OrbitCamera camera{view_at(50)};
    camera.keep_within(corridor);
    camera.orbit(M_PI / 2, 0);
    camera.advance(1);
    EXPECT_GE(corridor->of(camera.view().camera()).share, Corridor::end);
}

TEST(OrbitCameraInACorridor, OutsideItMovesInwardsOnly) {
    OrbitCamera camera{view_at(100)};
    camera.keep_within(corridor_of({-10, 10}));
    steps_of_a_turning_hand(camera, 100, 1);
    EXPECT_NEAR(camera.view().azimuth_rad, 100 * deg, 1e-9);
    steps_of_a_turning_hand(camera, 100, -1);
    EXPECT_LT(camera.view().azimuth_rad, 70 * deg);
}

TEST(OrbitCameraInACorridor, FliesToAShotInsideThroughUncoveredViews) {
    const auto corridor = corridor_of({0, 180});
    ASSERT_LT(corridor->of(view_at(90).camera()).share, Corridor::end);
    OrbitCamera camera{view_at(0)};
    camera.keep_within(corridor);
    camera.fly_to(view_at(179));
    settle(camera);
    EXPECT_NEAR(camera.view().azimuth_rad, 179 * deg, 1e-6);
}

TEST(OrbitCameraInACorridor, FliesToTheEndForAShotOutside) {
    const auto corridor = corridor_of({-10, 10});
    OrbitCamera camera{view_at(0)};
    camera.keep_within(corridor);
    camera.fly_to(view_at(120));
    settle(camera);
    EXPECT_GE(corridor->of(camera.view().camera()).share, Corridor::end);
    EXPECT_GT(camera.view().azimuth_rad, 30 * deg);
}

TEST(OrbitCameraInACorridor, FliesAnywhereWithoutACorridor) {
    OrbitCamera camera{view_at(0)};
    camera.keep_within(corridor_of({-10, 10}));
    camera.keep_within(nullptr);
    camera.orbit(2, 0);
    settle(camera);
    EXPECT_NEAR(camera.view().azimuth_rad, 2, 1e-6);
}

}  // namespace
}  // namespace vantage
