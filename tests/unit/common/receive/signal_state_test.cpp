#include "common/receive/signal_state.h"

#include <gtest/gtest.h>

namespace vantage {
namespace {

using namespace std::chrono_literals;

constexpr auto period = 40ms;
const MonotonicTime now = monotonic_from_ns(0) + 1h;

ReceiverStatus stage_with_a_background_of(std::chrono::nanoseconds age) {
    ReceiverStatus status;
    status.rigs.resize(2);
    status.rigs[1].connected = true;
    status.newest_frame_set = now - age;
    return status;
}

SignalState state_of(const ReceiverStatus& status) {
    return signal_state(status, false, period, now);
}

TEST(SignalState, IsLiveWhileFrameSetsCome) {
    EXPECT_EQ(state_of(stage_with_a_background_of(0ms)), SignalState::live);
    EXPECT_EQ(state_of(stage_with_a_background_of(period + stale_after)), SignalState::live);
}

TEST(SignalState, BecomesStaleAndThenNoSignal) {
    EXPECT_EQ(state_of(stage_with_a_background_of(period + stale_after + 1ns)), SignalState::stale);
    EXPECT_EQ(state_of(stage_with_a_background_of(period + no_signal_after)), SignalState::stale);
    EXPECT_EQ(state_of(stage_with_a_background_of(period + no_signal_after + 1ns)),
              SignalState::no_signal);
}

TEST(SignalState, ASlowStageIsNotStaleBetweenItsPulses) {
    EXPECT_EQ(signal_state(stage_with_a_background_of(5s), false, 5s, now), SignalState::live);
}

TEST(SignalState, IsNoSignalWithoutARig) {
    ReceiverStatus status = stage_with_a_background_of(10ms);
    for (RigStatus& rig : status.rigs) rig.connected = false;
    EXPECT_EQ(state_of(status), SignalState::no_signal);
}

TEST(SignalState, IsLiveIfEveryRigIsAtAnotherRate) {
    ReceiverStatus status = stage_with_a_background_of(10ms);
    status.rigs[1].stage_rate_hz = 10;
    status.rigs[1].sync.rate_hz = 5;
    EXPECT_EQ(state_of(status), SignalState::live);
}

TEST(SignalState, IsNoSignalBeforeTheFirstFrameSet) {
    ReceiverStatus status = stage_with_a_background_of(0ms);
    status.newest_frame_set.reset();
    EXPECT_EQ(state_of(status), SignalState::no_signal);
}

TEST(SignalState, IsHoldWhateverTheRigsDo) {
    EXPECT_EQ(signal_state(stage_with_a_background_of(1h), true, period, now), SignalState::hold);
}

TEST(SignalState, HasWordsForPeopleAndMachines) {
    EXPECT_STREQ(title_of(SignalState::no_signal), "NO SIGNAL");
    EXPECT_STREQ(key_of(SignalState::no_signal), "no_signal");
    EXPECT_STREQ(title_of(SignalState::hold), "HOLD");
    EXPECT_STREQ(key_of(SignalState::stale), "stale");
    EXPECT_STREQ(title_of(SignalState::live), "LIVE");
}

}  // namespace
}  // namespace vantage
