#include "host_app/desk/air_verdict.h"

#include <gtest/gtest.h>

namespace vantage {
namespace {

using Level = AirVerdict::Level;

DeskState good_state() {
    DeskState state;
    state.waiting = false;
    DeskRig north, south;
    north.name = "north";
    south.name = "south";
    north.state = south.state = RigState::present;
    state.rigs = {north, south};
    state.coverage = Coverage{.share = 0.97};
    return state;
}

TEST(AirVerdictTest, IsReadyWithoutFaults) {
    const AirVerdict verdict = air_verdict(good_state());
    EXPECT_EQ(verdict.level, Level::ready);
    EXPECT_EQ(verdict.why, "");
}

TEST(AirVerdictTest, IsNotReadyWithoutACurrentPicture) {
    DeskState state = good_state();
    state.waiting = true;
    EXPECT_EQ(air_verdict(state).level, Level::not_ready);
    EXPECT_EQ(air_verdict(state).why, "no rig has sent a frame yet");
    state.has_frame_sets = true;
    EXPECT_EQ(air_verdict(state).why, "the renderer compiles its shaders");
    state = good_state();
    state.signal = SignalState::stale;
    EXPECT_EQ(air_verdict(state).level, Level::not_ready);
    state.signal = SignalState::no_signal;
    EXPECT_EQ(air_verdict(state).level, Level::not_ready);
    EXPECT_NE(air_verdict(state).why, "");
}

TEST(AirVerdictTest, ReportsAHostThatIsTooSlow) {
    DeskState state = good_state();
    state.tick_rate_hz = 50;
    state.repeat_rate_hz = 10;
    state.age_s = 0.4;
    EXPECT_EQ(air_verdict(state).level, Level::ready);
    state.repeat_rate_hz = 20.4;
    EXPECT_EQ(air_verdict(state).level, Level::caution);
    EXPECT_EQ(air_verdict(state).why, "20 of 50 fps are repeated frames");
    state.age_s = 1.26;
    EXPECT_EQ(air_verdict(state).level, Level::caution);
    EXPECT_EQ(air_verdict(state).why, "the picture is 1.3 s old");
    state.age_s = 4;
    EXPECT_EQ(air_verdict(state).level, Level::not_ready);
    EXPECT_EQ(air_verdict(state).why, "the picture is 4 s old");
}

TEST(AirVerdictTest, AHeldPictureIsReady) {
    DeskState state = good_state();
    state.signal = SignalState::hold;
    EXPECT_EQ(air_verdict(state).level, Level::ready);
}

TEST(AirVerdictTest, NamesAMissingRig) {
    DeskState state = good_state();
    state.rigs[1].state = RigState::disconnected;
    EXPECT_EQ(air_verdict(state).level, Level::ready) << "it was there a moment ago";
    state.rigs[1].absent_s = 1.5;
    EXPECT_EQ(air_verdict(state).level, Level::caution);
    EXPECT_EQ(air_verdict(state).why, "south: no link");
}

TEST(AirVerdictTest, DistinguishesTheEdgeOfTheCorridorFromOutside) {
    DeskState state = good_state();
    state.coverage = Coverage{.share = 0.75};
    EXPECT_EQ(air_verdict(state).level, Level::caution);
    EXPECT_EQ(air_verdict(state).why, "the rigs cover 75 % of the picture");
    state.coverage = Coverage{.share = 0.3};
    EXPECT_EQ(air_verdict(state).level, Level::not_ready);
}

TEST(AirVerdictTest, ReportsOutputsTakesAndHeat) {
    DeskState state = good_state();
    state.rigs[0].worries = {"83 C, it throttles from 80 C on"};
    EXPECT_EQ(air_verdict(state).why, "north: 83 C, it throttles from 80 C on");
    state.computer_worry = "this computer is short of memory";
    EXPECT_EQ(air_verdict(state).why, "north: 83 C, it throttles from 80 C on");
    state.rigs[0].worries.clear();
    EXPECT_EQ(air_verdict(state).why, "this computer is short of memory");
    state.take.emplace().trouble = "the disk is slow: data waits 3 s to be written";
    EXPECT_EQ(air_verdict(state).why, "the disk is slow: data waits 3 s to be written");
    state.take->failure = "the disk is full";
    EXPECT_EQ(air_verdict(state).why, "the take has failed");
    DeskOutput output;
    output.name = "srt://house:9000";
    output.is_failed = true;
    state.outputs = {output};
    EXPECT_EQ(air_verdict(state).why, "srt://house:9000 has failed");
    EXPECT_EQ(air_verdict(state).level, Level::caution);
}

TEST(AirVerdictTest, ATakeNeedsNoSignal) {
    DeskState state = good_state();
    state.signal = SignalState::no_signal;
    state.time.emplace().is_of_take = true;
    EXPECT_EQ(air_verdict(state).level, Level::ready);
    state.rigs[0].state = RigState::late;
    state.rigs[0].absent_s = 5;
    EXPECT_EQ(air_verdict(state).why, "north: not in the take");
}

}  // namespace
}  // namespace vantage
