#include "host_app/flight/flight_controller.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

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

class FlightControllerTest : public testing::Test {
  protected:
    static void pass(FlightController& flight_controller, double seconds,
                     const FlightInput& each_time = {}) {
        for (double t = 0; t < seconds - 1e-9; t += 0.02) {
            flight_controller.take(each_time, no_rig);
            flight_controller.advance(0.02);
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

TEST_F(FlightControllerTest, WheelStepTurnsTheOrbitByOneDegree) {
    FlightController flight_controller(looking(0), {});
    flight_controller.take(steps(3), no_rig);
    flight_controller.advance(0.02);
    EXPECT_GT(flight_controller.view().azimuth_rad, 0) << "visible in the next frame";
    pass(flight_controller, 3);
    EXPECT_NEAR(flight_controller.view().azimuth_rad, 3 * deg, 1e-9);
}

TEST_F(FlightControllerTest, ShuttleTurnsTheOrbitUntilItIsReleased) {
    FlightController flight_controller(looking(0), {});
    pass(flight_controller, 1, shuttle(0.02));
    pass(flight_controller, 3);
    const double there = flight_controller.view().azimuth_rad;
    EXPECT_NEAR(there, 30 * deg, 1e-9);
    pass(flight_controller, 1);
    EXPECT_NEAR(flight_controller.view().azimuth_rad, there, 1e-9);
}

TEST_F(FlightControllerTest, PlaysAMoveUntilTheWheelTurns) {
    FlightController flight_controller(looking(0), straight_move());
    EXPECT_EQ(flight_controller.wheel_mode(), WheelMode::move);
    pass(flight_controller, 2);
    EXPECT_NEAR(flight_controller.view().azimuth_rad, 2, 1e-9);
    flight_controller.take(steps(-10), no_rig);
    pass(flight_controller, 3);
    EXPECT_NEAR(flight_controller.view().azimuth_rad, 1, 1e-6) << "a step is 0.1 s";
    EXPECT_NEAR(*flight_controller.move_progress(), 0.1, 1e-6);
    pass(flight_controller, 1);
    EXPECT_NEAR(flight_controller.view().azimuth_rad, 1, 1e-6) << "it stays there";
}

TEST_F(FlightControllerTest, ShuttleDrivesAMoveBothWaysToItsEnds) {
    FlightController flight_controller(looking(0), straight_move());
    pass(flight_controller, 1, shuttle(0.04));
    EXPECT_NEAR(flight_controller.view().azimuth_rad, 2, 0.03) << "at 2x";
    pass(flight_controller, 1, shuttle(-0.06));
    EXPECT_NEAR(flight_controller.view().azimuth_rad, 0, 1e-9);
    pass(flight_controller, 1, shuttle(1));
    EXPECT_NEAR(flight_controller.view().azimuth_rad, 10, 1e-9);
}

TEST_F(FlightControllerTest, WheelDrivesALoopEndlessly) {
    FlightController flight_controller(looking(0), straight_move(true));
    pass(flight_controller, 1, shuttle(-0.02));
    EXPECT_NEAR(std::remainder(flight_controller.view().azimuth_rad + 1, 2 * std::numbers::pi), 0,
                0.03);
    EXPECT_NEAR(*flight_controller.move_progress(), 1 - 1 / (2 * std::numbers::pi), 0.01);
}

TEST_F(FlightControllerTest, PlayContinuesWhereTheWheelStoppedTheMove) {
    FlightController flight_controller(looking(0), straight_move());
    pass(flight_controller, 2, shuttle(0.02));
    const double held = flight_controller.view().azimuth_rad;
    FlightInput play;
    play.commands = {command::ToggleMove{}};
    flight_controller.take(play, no_rig);
    pass(flight_controller, 1);
    EXPECT_NEAR(flight_controller.view().azimuth_rad, held + 1, 1e-9);
}

TEST_F(FlightControllerTest, InputTakesTheCameraOffTheMoveWithoutAJump) {
    FlightController flight_controller(looking(0), straight_move());
    pass(flight_controller, 2);
    FlightInput drag;
    drag.orbit_elevation_rad = 0.001;
    flight_controller.take(drag, no_rig);
    flight_controller.advance(0.02);
    EXPECT_NEAR(flight_controller.view().azimuth_rad, 2, 1e-9);
    EXPECT_FALSE(flight_controller.move_progress());
    pass(flight_controller, 1);
    EXPECT_NEAR(flight_controller.view().azimuth_rad, 2, 1e-9);
}

TEST_F(FlightControllerTest, WheelGlidesBackOntoTheMove) {
    FlightController flight_controller(looking(0), straight_move());
    pass(flight_controller, 2);
    FlightInput drag;
    drag.orbit_azimuth_rad = 1;
    flight_controller.take(drag, no_rig);
    pass(flight_controller, 3);
    flight_controller.take(steps(1), no_rig);
    double last = flight_controller.view().azimuth_rad;
    EXPECT_NEAR(last, 3, 1e-9);
    for (int i = 0; i < 100; ++i) {
        flight_controller.advance(0.02);
        EXPECT_LT(std::abs(flight_controller.view().azimuth_rad - last), 0.06) << "no jump";
        last = flight_controller.view().azimuth_rad;
    }
    EXPECT_NEAR(last, 2.1, 1e-6);
}

TEST_F(FlightControllerTest, WheelModeMoveNeedsAMove) {
    FlightInput mode;
    mode.commands = {command::NextWheelMode{}};
    FlightController with(looking(0), straight_move());
    with.take(mode, no_rig);
    EXPECT_EQ(with.wheel_mode(), WheelMode::orbit);
    with.take(mode, no_rig);
    EXPECT_EQ(with.wheel_mode(), WheelMode::move);
    FlightController without(looking(0), {});
    without.take(mode, no_rig);
    EXPECT_EQ(without.wheel_mode(), WheelMode::orbit);
}

TEST_F(FlightControllerTest, WheelModePastDoesNotMoveTheCamera) {
    FlightInput mode;
    mode.commands = {command::NextWheelMode{}};
    FlightController flight_controller(looking(0), {}, true);
    flight_controller.take(mode, no_rig);
    EXPECT_EQ(flight_controller.wheel_mode(), WheelMode::past);
    flight_controller.take(steps(5), no_rig);
    pass(flight_controller, 1);
    EXPECT_EQ(flight_controller.view().azimuth_rad, 0);
    flight_controller.take(mode, no_rig);
    EXPECT_EQ(flight_controller.wheel_mode(), WheelMode::orbit);
    FlightController with_move(looking(0), straight_move(), true);
    for (const WheelMode next : {WheelMode::past, WheelMode::orbit, WheelMode::move}) {
        with_move.take(mode, no_rig);
        EXPECT_EQ(with_move.wheel_mode(), next);
    }
}

TEST_F(FlightControllerTest, FliesToStoredShotsOrToTheViewOfARig) {
    FlightController flight_controller(looking(0), {});
    FlightInput input;
    input.commands = {command::RecallShot{2}};
    flight_controller.take(input, [](int number) { return std::optional(looking(0.1 * number)); });
    pass(flight_controller, 3);
    EXPECT_NEAR(flight_controller.view().azimuth_rad, 0.2, 1e-6);
    input = {};
    input.commands = {command::StoreShot{2}};
    flight_controller.take(input, no_rig);
    flight_controller.take(steps(20), no_rig);
    pass(flight_controller, 3);
    input = {};
    input.commands = {command::RecallShot{2}};
    flight_controller.take(input, no_rig);
    pass(flight_controller, 3);
    EXPECT_NEAR(flight_controller.view().azimuth_rad, 0.2, 1e-6);
    input.commands = {command::RecallShot{5}};
    flight_controller.take(input, no_rig);
    pass(flight_controller, 1);
    EXPECT_NEAR(flight_controller.view().azimuth_rad, 0.2, 1e-6)
        << "shot 5 was not stored and there is no rig 5";
}

TEST_F(FlightControllerTest, FlightToAShotKeepsItsDurationAndEndsAtRest) {
    FlightController flight_controller(looking(0), {});
    FlightBook book;
    book.shots[3] = Shot{"left", looking(1), 4, Easing::linear};
    book.shots[4] = Shot{"there", looking(-1), 0, Easing::ease};
    flight_controller.keep(book);
    FlightInput recall;
    recall.commands = {command::RecallShot{4}};
    flight_controller.take(recall, no_rig);
    pass(flight_controller, 1);
    EXPECT_NEAR(flight_controller.view().azimuth_rad, 0.25, 1e-9);
    pass(flight_controller, 3);
    EXPECT_NEAR(flight_controller.view().azimuth_rad, 1, 1e-9);
    recall.commands = {command::RecallShot{5}};
    flight_controller.take(recall, no_rig);
    EXPECT_NEAR(flight_controller.view().azimuth_rad, -1, 1e-9) << "at once";
    EXPECT_FALSE(flight_controller.take_change()) << "nothing was stored";
}

TEST_F(FlightControllerTest, FlightToAShotKeepsTheSpeedLimits) {
    FlightController flight_controller(looking(0), {});
    FlightBook book;
    book.shots[0] = Shot{"behind", looking(3), 0.1, Easing::ease};
    flight_controller.keep(book);
    FlightInput recall;
    recall.commands = {command::RecallShot{1}};
    flight_controller.take(recall, no_rig);
    double last = 0;
    for (int i = 0; i < 200; ++i) {
        flight_controller.advance(0.02);
        EXPECT_LE(flight_controller.view().azimuth_rad - last,
                  0.02 * FlightLimits().max_turn_rad_s + 1e-9);
        last = flight_controller.view().azimuth_rad;
    }
    EXPECT_NEAR(last, 3, 1e-9);
}

TEST_F(FlightControllerTest, InputEndsAFlightToAShot) {
    FlightController flight_controller(looking(0), {});
    FlightInput store, drag, recall;
    store.commands = {command::StoreShot{1}};
    flight_controller.take(store, no_rig);
    drag.orbit_azimuth_rad = 1;
    flight_controller.take(drag, no_rig);
    pass(flight_controller, 3);
    recall.commands = {command::RecallShot{1}};
    flight_controller.take(recall, no_rig);
    pass(flight_controller, 0.4);
    const double here = flight_controller.view().azimuth_rad;
    drag.orbit_azimuth_rad = 1e-6;
    flight_controller.take(drag, no_rig);
    pass(flight_controller, 1);
    EXPECT_NEAR(flight_controller.view().azimuth_rad, here, 1e-3);
}

TEST_F(FlightControllerTest, HoldsTheHorizonUnlessItIsSwitchedOff) {
    FlightController flight_controller(looking(0), {});
    FlightInput roll, toggle;
    roll.roll_rad = 0.2;
    flight_controller.take(roll, no_rig);
    pass(flight_controller, 2);
    EXPECT_NEAR(flight_controller.view().roll_rad, 0, 1e-9);
    toggle.commands = {command::ToggleHorizon{}};
    flight_controller.take(toggle, no_rig);
    EXPECT_FALSE(flight_controller.holds_horizon());
    flight_controller.take(roll, no_rig);
    pass(flight_controller, 2);
    EXPECT_NEAR(flight_controller.view().roll_rad, 0.2, 1e-6);
    flight_controller.take(toggle, no_rig);
    const double before = flight_controller.view().roll_rad;
    flight_controller.advance(0.02);
    EXPECT_GT(flight_controller.view().roll_rad, before - 0.05) << "it levels without a jump";
    pass(flight_controller, 3);
    EXPECT_NEAR(flight_controller.view().roll_rad, 0, 1e-6);
}

TEST_F(FlightControllerTest, TurnsToANewPivotInPlace) {
    FlightController flight_controller(looking(0), {});
    const Eigen::Vector3d eye = flight_controller.view().eye_m(), pivot(0.8, 1.4, -1);
    FlightInput input;
    input.commands = {command::LookAt{pivot}};
    flight_controller.take(input, no_rig);
    pass(flight_controller, 4);
    EXPECT_TRUE(flight_controller.view().pivot_m.isApprox(pivot, 1e-6));
    EXPECT_TRUE(flight_controller.view().eye_m().isApprox(eye, 1e-6));
}

TEST_F(FlightControllerTest, MovesWithAPivotThatIsCarried) {
    FlightController flight_controller(looking(0), {});
    const Eigen::Vector3d before = flight_controller.view().eye_m();
    for (int i = 1; i <= 50; ++i) {
        flight_controller.carry_pivot_to({0.02 * i, 1, 0});
        flight_controller.advance(0.02);
    }
    pass(flight_controller, 2);
    EXPECT_NEAR(flight_controller.view().pivot_m.x(), 1, 1e-6);
    EXPECT_TRUE(
        (flight_controller.view().eye_m() - before).isApprox(Eigen::Vector3d(1, 0, 0), 1e-6));
    FlightController on_move(looking(0), straight_move());
    on_move.carry_pivot_to({5, 1, 0});
    pass(on_move, 1);
    EXPECT_NEAR(on_move.view().pivot_m.x(), 0, 1e-9) << "a move does not follow the pivot";
}

TEST_F(FlightControllerTest, AppliesTheHabitsOfTheStage) {
    FlightHabits habits;
    habits.shot_s = 4;
    habits.keyframe_gap_s = 7;
    habits.max_turn_rad_s = 0.1;
    habits.holds_horizon = false;
    FlightController flight_controller(looking(0), {}, false, habits);
    EXPECT_FALSE(flight_controller.holds_horizon());
    flight_controller.settle({}, {});
    FlightInput drag, store, put;
    drag.orbit_azimuth_rad = 3;
    flight_controller.take(drag, no_rig);
    pass(flight_controller, 5);
    EXPECT_LT(flight_controller.view().azimuth_rad, 0.51);
    store.commands = {command::StoreShot{2}};
    put.commands = {command::AddKeyframe{}};
    flight_controller.take(store, no_rig);
    flight_controller.take(put, no_rig);
    flight_controller.take(put, no_rig);
    const FlightBook book = flight_controller.take_change()->book;
    EXPECT_EQ(book.shots[1]->duration_s, 4);
    EXPECT_EQ(book.move->duration_s(), 7);
}

TEST_F(FlightControllerTest, BuildsAMoveFromViewsAndReportsTheChange) {
    FlightController flight_controller(looking(0), {});
    FlightInput put, drag, play;
    put.commands = {command::AddKeyframe{}};
    flight_controller.take(put, no_rig);
    drag.orbit_azimuth_rad = 1;
    flight_controller.take(drag, no_rig);
    pass(flight_controller, 3);
    flight_controller.take(put, no_rig);
    const std::optional<FlightController::Change> change = flight_controller.take_change();
    ASSERT_TRUE(change);
    EXPECT_TRUE(change->is_of_move);
    ASSERT_EQ(change->book.move->keyframes().size(), 2u);
    EXPECT_NEAR(change->book.move->keyframes()[1].view.azimuth_rad, 1, 1e-9);
    EXPECT_FALSE(flight_controller.take_change()) << "once";
    EXPECT_EQ(flight_controller.keyframes(), 2u);
    play.commands = {command::ToggleMove{}};
    flight_controller.take(play, no_rig);
    EXPECT_NEAR(flight_controller.view().azimuth_rad, 0, 1e-9) << "the move plays from its start";
    pass(flight_controller, 3.1);
    EXPECT_NEAR(flight_controller.view().azimuth_rad, 1, 1e-9);
}

TEST_F(FlightControllerTest, EditsTheKeyframeAtThePositionOfTheMove) {
    FlightController flight_controller(looking(0), straight_move());
    flight_controller.take(steps(-1), no_rig);
    FlightInput jump, put, drag, later, out;
    jump.commands = {command::JumpKeyframes{1}};
    flight_controller.take(jump, no_rig);
    pass(flight_controller, 3);
    EXPECT_NEAR(*flight_controller.move_progress(), 1, 1e-6);
    drag.orbit_elevation_rad = 0.3;
    flight_controller.take(drag, no_rig);
    pass(flight_controller, 3);
    put.commands = {command::SetKeyframe{}};
    flight_controller.take(put, no_rig);
    EXPECT_NEAR(flight_controller.take_change()->book.move->keyframes()[1].view.elevation_rad, 0.3,
                1e-6);
    flight_controller.take(jump, no_rig);
    pass(flight_controller, 2);
    later.retime_s = -2;
    flight_controller.take(later, no_rig);
    EXPECT_NEAR(flight_controller.take_change()->book.move->duration_s(), 8, 1e-9);
    EXPECT_NEAR(flight_controller.view().azimuth_rad, 10, 1e-6)
        << "the position moves with the keyframe";
    out.commands = {command::RemoveKeyframe{}};
    flight_controller.take(out, no_rig);
    flight_controller.take(out, no_rig);
    EXPECT_FALSE(flight_controller.take_change()->book.move);
    EXPECT_FALSE(flight_controller.move_progress());
    pass(flight_controller, 1);
    EXPECT_EQ(flight_controller.wheel_mode(), WheelMode::orbit);
}

TEST(FlightInput, AddsAxesAndAppendsCommandsInOrder) {
    FlightInput a{.wheel_steps = 1, .commands = {command::RecallShot{3}}};
    a.add({.wheel_steps = 2, .commands = {command::ToggleHold{}, command::RecallShot{4}}});
    EXPECT_EQ(a.wheel_steps, 3);
    ASSERT_EQ(a.commands.size(), 3u);
    EXPECT_TRUE(a.find<command::ToggleHold>());
    EXPECT_EQ(a.find<command::RecallShot>()->number, 4) << "the last one of its type";
    EXPECT_FALSE(a.find<command::Cut>());
    EXPECT_FALSE(a.turns_camera());
    EXPECT_TRUE(a.steers());
}

TEST_F(FlightControllerTest, ExecutesTheCommandsOfOneInputInOrder) {
    FlightController flight_controller(looking(0), {});
    flight_controller.take({.commands = {command::AddKeyframe{}, command::AddKeyframe{},
                                         command::RemoveKeyframe{}, command::StoreShot{2}}},
                           no_rig);
    EXPECT_EQ(flight_controller.keyframes(), 1u);
    flight_controller.take({.commands = {command::RemoveKeyframe{}, command::AddKeyframe{}}},
                           no_rig);
    EXPECT_EQ(flight_controller.keyframes(), 1u);
    EXPECT_TRUE(flight_controller.take_change()->book.shots[1]);
}

TEST(FlightControllerInACorridor, PlannedMoveIsNotLimited) {
    FlightController flight_controller(
        view_at(0),
        Move({{0, view_at(0), Easing::linear}, {4, view_at(120), Easing::linear}}, false));
    flight_controller.keep_within(corridor_of({-10, 10}));
    for (int i = 0; i < 250; ++i) flight_controller.advance(0.02);
    EXPECT_NEAR(flight_controller.view().azimuth_rad, view_at(120).azimuth_rad, 1e-9);
}

TEST(FlightControllerInACorridor, StaysInsideAfterTheFramingIsKnown) {
    FlightController flight_controller(view_at(0), std::nullopt);
    const auto corridor = corridor_of({-10, 10});
    flight_controller.keep_within(corridor);
    flight_controller.settle({}, std::nullopt);
    for (int i = 0; i < 500; ++i) {
        flight_controller.take({.orbit_azimuth_rad = 0.01}, [](int) { return std::nullopt; });
        flight_controller.advance(0.02);
    }
    EXPECT_GE(corridor->of(flight_controller.view().camera()).share, Corridor::end);
}

}  // namespace
}  // namespace vantage
