#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "host_app/flight/flight_controller.h"
#include "tests/unit/host_app/flight/looking.h"
#include "tests/unit/host_app/flight/ring_of_rigs.h"

namespace vantage {
namespace {

std::optional<OrbitView> no_rig(int) { return std::nullopt; }

/// 1 rad/s from 0 to 10 rad.
Move straight_move(bool loop = false) {
    const double end = loop ? 2 * std::numbers::pi : 10;
    return Move({{0, looking(0), Easing::linear}, {end, looking(end), Easing::linear}}, loop);
}

class HelmTest : public testing::Test {
  protected:
    static void pass(Helm& helm, double seconds, const FlightInput& each_time = {}) {
        for (double t = 0; t < seconds - 1e-9; t += 0.02) {
            helm.take(each_time, no_rig);
            helm.advance(0.02);
        }
    }
    static FlightInput steps(double n) {
        FlightInput input;
        input.wheel_steps = n;
        return input;
    }
    static FlightInput shuttle(double seconds) {
        FlightInput input;
        input.shuttle_s = seconds;
        return input;
    }
};

TEST_F(HelmTest, WheelStepsGoAroundTheOrbitByADegree) {
    Helm helm(looking(0), {});
    helm.take(steps(3), no_rig);
    helm.advance(0.02);
    EXPECT_GT(helm.view().azimuth_rad, 0) << "to be seen in the very next picture";
    pass(helm, 3);
    EXPECT_NEAR(helm.view().azimuth_rad, 3 * deg, 1e-9);
}

TEST_F(HelmTest, ShuttleGoesAroundTheOrbitAndStopsWhenItIsLetGo) {
    Helm helm(looking(0), {});
    pass(helm, 1, shuttle(0.02));
    pass(helm, 3);
    const double there = helm.view().azimuth_rad;
    EXPECT_NEAR(there, 30 * deg, 1e-9);
    pass(helm, 1);
    EXPECT_NEAR(helm.view().azimuth_rad, there, 1e-9);
}

TEST_F(HelmTest, PlaysAMoveUntilTheWheelTakesHold) {
    Helm helm(looking(0), straight_move());
    EXPECT_EQ(helm.wheel_mode(), WheelMode::move);
    pass(helm, 2);
    EXPECT_NEAR(helm.view().azimuth_rad, 2, 1e-9);
    helm.take(steps(-10), no_rig);
    pass(helm, 3);
    EXPECT_NEAR(helm.view().azimuth_rad, 1, 1e-6) << "a step is 0.1 s";
    EXPECT_NEAR(*helm.move_progress(), 0.1, 1e-6);
    pass(helm, 1);
    EXPECT_NEAR(helm.view().azimuth_rad, 1, 1e-6) << "it holds there";
}

TEST_F(HelmTest, ShuttleDrivesAMoveBothWaysAndEndsAtItsEnds) {
    Helm helm(looking(0), straight_move());
    pass(helm, 1, shuttle(0.04));
    EXPECT_NEAR(helm.view().azimuth_rad, 2, 0.03) << "at 2x";
    pass(helm, 1, shuttle(-0.06));
    EXPECT_NEAR(helm.view().azimuth_rad, 0, 1e-9);
    pass(helm, 1, shuttle(1));
    EXPECT_NEAR(helm.view().azimuth_rad, 10, 1e-9);
}

TEST_F(HelmTest, WheelTurnsALoopRoundAndRound) {
    Helm helm(looking(0), straight_move(true));
    pass(helm, 1, shuttle(-0.02));
    EXPECT_NEAR(std::remainder(helm.view().azimuth_rad + 1, 2 * std::numbers::pi), 0, 0.03);
    EXPECT_NEAR(*helm.move_progress(), 1 - 1 / (2 * std::numbers::pi), 0.01);
}

TEST_F(HelmTest, PlayGoesOnFromWhereTheWheelHeldTheMove) {
    Helm helm(looking(0), straight_move());
    pass(helm, 2, shuttle(0.02));
    const double held = helm.view().azimuth_rad;
    FlightInput play;
    play.toggle_move = true;
    helm.take(play, no_rig);
    pass(helm, 1);
    EXPECT_NEAR(helm.view().azimuth_rad, held + 1, 1e-9);
}

TEST_F(HelmTest, HandsTakeTheCameraOffTheMoveWithoutAJump) {
    Helm helm(looking(0), straight_move());
    pass(helm, 2);
    FlightInput drag;
    drag.orbit_elevation_rad = 0.001;
    helm.take(drag, no_rig);
    helm.advance(0.02);
    EXPECT_NEAR(helm.view().azimuth_rad, 2, 1e-9);
    EXPECT_FALSE(helm.move_progress());
    pass(helm, 1);
    EXPECT_NEAR(helm.view().azimuth_rad, 2, 1e-9);
}

TEST_F(HelmTest, WheelGlidesBackOntoTheMove) {
    Helm helm(looking(0), straight_move());
    pass(helm, 2);
    FlightInput drag;
    drag.orbit_azimuth_rad = 1;
    helm.take(drag, no_rig);
    pass(helm, 3);
    helm.take(steps(1), no_rig);
    double last = helm.view().azimuth_rad;
    EXPECT_NEAR(last, 3, 1e-9);
    for (int i = 0; i < 100; ++i) {
        helm.advance(0.02);
        EXPECT_LT(std::abs(helm.view().azimuth_rad - last), 0.06) << "no jump";
        last = helm.view().azimuth_rad;
    }
    EXPECT_NEAR(last, 2.1, 1e-6);
}

TEST_F(HelmTest, ModeChangesWhatTheWheelDrivesIfThereIsAMove) {
    FlightInput mode;
    mode.next_wheel_mode = true;
    Helm with(looking(0), straight_move());
    with.take(mode, no_rig);
    EXPECT_EQ(with.wheel_mode(), WheelMode::orbit);
    with.take(mode, no_rig);
    EXPECT_EQ(with.wheel_mode(), WheelMode::move);
    Helm without(looking(0), {});
    without.take(mode, no_rig);
    EXPECT_EQ(without.wheel_mode(), WheelMode::orbit);
}

TEST_F(HelmTest, LeavesTheCameraAloneWhileTheWheelGoesThroughThePast) {
    FlightInput mode;
    mode.next_wheel_mode = true;
    Helm helm(looking(0), {}, true);
    helm.take(mode, no_rig);
    EXPECT_EQ(helm.wheel_mode(), WheelMode::past);
    helm.take(steps(5), no_rig);
    pass(helm, 1);
    EXPECT_EQ(helm.view().azimuth_rad, 0);
    helm.take(mode, no_rig);
    EXPECT_EQ(helm.wheel_mode(), WheelMode::orbit);
    Helm with_move(looking(0), straight_move(), true);
    for (const WheelMode next : {WheelMode::past, WheelMode::orbit, WheelMode::move}) {
        with_move.take(mode, no_rig);
        EXPECT_EQ(with_move.wheel_mode(), next);
    }
}

TEST_F(HelmTest, FliesToShotsStoredElseToWhatARigSees) {
    Helm helm(looking(0), {});
    FlightInput input;
    input.recall_shot = 2;
    helm.take(input, [](int number) { return std::optional(looking(0.1 * number)); });
    pass(helm, 3);
    EXPECT_NEAR(helm.view().azimuth_rad, 0.2, 1e-6);
    input = {};
    input.store_shot = 2;
    helm.take(input, no_rig);
    helm.take(steps(20), no_rig);
    pass(helm, 3);
    input = {};
    input.recall_shot = 2;
    helm.take(input, no_rig);
    pass(helm, 3);
    EXPECT_NEAR(helm.view().azimuth_rad, 0.2, 1e-6);
    input.recall_shot = 5;
    helm.take(input, no_rig);
    pass(helm, 1);
    EXPECT_NEAR(helm.view().azimuth_rad, 0.2, 1e-6) << "nobody stored it and there is no rig 5";
}

TEST_F(HelmTest, FliesToAShotInItsTimeAndRestsThere) {
    Helm helm(looking(0), {});
    FlightBook book;
    book.shots[3] = Shot{"left", looking(1), 4, Easing::linear};
    book.shots[4] = Shot{"there", looking(-1), 0, Easing::ease};
    helm.keep(book);
    FlightInput recall;
    recall.recall_shot = 4;
    helm.take(recall, no_rig);
    pass(helm, 1);
    EXPECT_NEAR(helm.view().azimuth_rad, 0.25, 1e-9);
    pass(helm, 3);
    EXPECT_NEAR(helm.view().azimuth_rad, 1, 1e-9);
    recall.recall_shot = 5;
    helm.take(recall, no_rig);
    EXPECT_NEAR(helm.view().azimuth_rad, -1, 1e-9) << "at once";
    EXPECT_FALSE(helm.take_change()) << "nothing was stored";
}

TEST_F(HelmTest, FliesToAFarShotNoFasterThanTheLimits) {
    Helm helm(looking(0), {});
    FlightBook book;
    book.shots[0] = Shot{"behind", looking(3), 0.1, Easing::ease};
    helm.keep(book);
    FlightInput recall;
    recall.recall_shot = 1;
    helm.take(recall, no_rig);
    double last = 0;
    for (int i = 0; i < 200; ++i) {
        helm.advance(0.02);
        EXPECT_LE(helm.view().azimuth_rad - last, 0.02 * FlightLimits().max_turn_rad_s + 1e-9);
        last = helm.view().azimuth_rad;
    }
    EXPECT_NEAR(last, 3, 1e-9);
}

TEST_F(HelmTest, AHandEndsTheFlightToAShotWhereItIs) {
    Helm helm(looking(0), {});
    FlightInput store, drag, recall;
    store.store_shot = 1;
    helm.take(store, no_rig);
    drag.orbit_azimuth_rad = 1;
    helm.take(drag, no_rig);
    pass(helm, 3);
    recall.recall_shot = 1;
    helm.take(recall, no_rig);
    pass(helm, 0.4);
    const double here = helm.view().azimuth_rad;
    drag.orbit_azimuth_rad = 1e-6;
    helm.take(drag, no_rig);
    pass(helm, 1);
    EXPECT_NEAR(helm.view().azimuth_rad, here, 1e-3);
}

TEST_F(HelmTest, HoldsTheHorizonUnlessItIsLetGo) {
    Helm helm(looking(0), {});
    FlightInput roll, toggle;
    roll.roll_rad = 0.2;
    helm.take(roll, no_rig);
    pass(helm, 2);
    EXPECT_NEAR(helm.view().roll_rad, 0, 1e-9);
    toggle.toggle_horizon = true;
    helm.take(toggle, no_rig);
    EXPECT_FALSE(helm.holds_horizon());
    helm.take(roll, no_rig);
    pass(helm, 2);
    EXPECT_NEAR(helm.view().roll_rad, 0.2, 1e-6);
    helm.take(toggle, no_rig);
    const double before = helm.view().roll_rad;
    helm.advance(0.02);
    EXPECT_GT(helm.view().roll_rad, before - 0.05) << "it levels without a jump";
    pass(helm, 3);
    EXPECT_NEAR(helm.view().roll_rad, 0, 1e-6);
}

TEST_F(HelmTest, TurnsToAPivotWhereItStands) {
    Helm helm(looking(0), {});
    const Eigen::Vector3d eye = helm.view().eye_m(), pivot(0.8, 1.4, -1);
    FlightInput input;
    input.pivot_m = pivot;
    helm.take(input, no_rig);
    pass(helm, 4);
    EXPECT_TRUE(helm.view().pivot_m.isApprox(pivot, 1e-6));
    EXPECT_TRUE(helm.view().eye_m().isApprox(eye, 1e-6));
}

TEST_F(HelmTest, GoesWithAPivotThatIsCarried) {
    Helm helm(looking(0), {});
    const Eigen::Vector3d before = helm.view().eye_m();
    for (int i = 1; i <= 50; ++i) {
        helm.carry_pivot_to({0.02 * i, 1, 0});
        helm.advance(0.02);
    }
    pass(helm, 2);
    EXPECT_NEAR(helm.view().pivot_m.x(), 1, 1e-6);
    EXPECT_TRUE((helm.view().eye_m() - before).isApprox(Eigen::Vector3d(1, 0, 0), 1e-6));
    Helm on_move(looking(0), straight_move());
    on_move.carry_pivot_to({5, 1, 0});
    pass(on_move, 1);
    EXPECT_NEAR(on_move.view().pivot_m.x(), 0, 1e-9) << "a move is not carried";
}

TEST_F(HelmTest, FliesAsTheStageSays) {
    FlightHabits habits;
    habits.shot_s = 4;
    habits.keyframe_gap_s = 7;
    habits.max_turn_rad_s = 0.1;
    habits.holds_horizon = false;
    Helm helm(looking(0), {}, false, habits);
    EXPECT_FALSE(helm.holds_horizon());
    helm.settle({}, {});
    FlightInput drag, store, put;
    drag.orbit_azimuth_rad = 3;
    helm.take(drag, no_rig);
    pass(helm, 5);
    EXPECT_LT(helm.view().azimuth_rad, 0.51);
    store.store_shot = 2;
    put.add_keyframe = true;
    helm.take(store, no_rig);
    helm.take(put, no_rig);
    helm.take(put, no_rig);
    const FlightBook book = helm.take_change()->book;
    EXPECT_EQ(book.shots[1]->duration_s, 4);
    EXPECT_EQ(book.move->duration_s(), 7);
}

TEST_F(HelmTest, MakesAMoveOfViewsAndTellsOfIt) {
    Helm helm(looking(0), {});
    FlightInput put, drag, play;
    put.add_keyframe = true;
    helm.take(put, no_rig);
    drag.orbit_azimuth_rad = 1;
    helm.take(drag, no_rig);
    pass(helm, 3);
    helm.take(put, no_rig);
    const std::optional<Helm::Change> change = helm.take_change();
    ASSERT_TRUE(change);
    EXPECT_TRUE(change->is_of_move);
    ASSERT_EQ(change->book.move->keyframes().size(), 2u);
    EXPECT_NEAR(change->book.move->keyframes()[1].view.azimuth_rad, 1, 1e-9);
    EXPECT_FALSE(helm.take_change()) << "once";
    EXPECT_EQ(helm.keyframes(), 2u);
    play.toggle_move = true;
    helm.take(play, no_rig);
    EXPECT_NEAR(helm.view().azimuth_rad, 0, 1e-9) << "from its start";
    pass(helm, 3.1);
    EXPECT_NEAR(helm.view().azimuth_rad, 1, 1e-9);
}

TEST_F(HelmTest, ChangesTheKeyframeWhereTheWheelHoldsTheMove) {
    Helm helm(looking(0), straight_move());
    helm.take(steps(-1), no_rig);
    FlightInput jump, put, drag, later, out;
    jump.keyframe_jump = 1;
    helm.take(jump, no_rig);
    pass(helm, 3);
    EXPECT_NEAR(*helm.move_progress(), 1, 1e-6);
    drag.orbit_elevation_rad = 0.3;
    helm.take(drag, no_rig);
    pass(helm, 3);
    put.set_keyframe = true;
    helm.take(put, no_rig);
    EXPECT_NEAR(helm.take_change()->book.move->keyframes()[1].view.elevation_rad, 0.3, 1e-6);
    helm.take(jump, no_rig);
    pass(helm, 2);
    later.retime_s = -2;
    helm.take(later, no_rig);
    EXPECT_NEAR(helm.take_change()->book.move->duration_s(), 8, 1e-9);
    EXPECT_NEAR(helm.view().azimuth_rad, 10, 1e-6) << "it stands at the keyframe that it retimes";
    out.remove_keyframe = true;
    helm.take(out, no_rig);
    helm.take(out, no_rig);
    EXPECT_FALSE(helm.take_change()->book.move);
    EXPECT_FALSE(helm.move_progress());
    pass(helm, 1);
    EXPECT_EQ(helm.wheel_mode(), WheelMode::orbit);
}

TEST(FlightInput, TwoHandsOnOneSwitchUndoEachOther) {
    FlightInput a, b;
    a.toggle_freeze = b.toggle_freeze = true;
    a.wheel_steps = 1;
    b.wheel_steps = 2;
    a.add(b);
    EXPECT_FALSE(a.toggle_freeze);
    EXPECT_EQ(a.wheel_steps, 3);
}

TEST(HelmInACorridor, APlannedMoveIsNotHeldUp) {
    Helm helm(view_at(0),
              Move({{0, view_at(0), Easing::linear}, {4, view_at(120), Easing::linear}}, false));
    helm.keep_within(corridor_of({-10, 10}));
    for (int i = 0; i < 250; ++i) helm.advance(0.02);
    EXPECT_NEAR(helm.view().azimuth_rad, view_at(120).azimuth_rad, 1e-9);
}

TEST(HelmInACorridor, IsKeptInItAfterTheStageIsKnown) {
    Helm helm(view_at(0), std::nullopt);
    const auto corridor = corridor_of({-10, 10});
    helm.keep_within(corridor);
    helm.settle({}, std::nullopt);
    for (int i = 0; i < 500; ++i) {
        helm.take({.orbit_azimuth_rad = 0.01}, [](int) { return std::nullopt; });
        helm.advance(0.02);
    }
    EXPECT_GE(corridor->of(helm.view().camera()).share, Corridor::end);
}

}  // namespace
}  // namespace vantage
