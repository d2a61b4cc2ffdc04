#include "rig_firmware/trigger/pulse_schedule.h"

#include <gtest/gtest.h>

namespace vantage {
namespace {

using namespace std::chrono_literals;

constexpr std::uint64_t k0 = 100'000'000;

class PulseScheduleTest : public testing::Test {
  protected:
    TaiTime at(std::uint64_t index) const { return grid_.time_of(index); }
    bool send(std::uint64_t index, std::chrono::nanoseconds late) {
        return schedule_.send(index, at(index) + late).has_value();
    }

    PulseGrid grid_{100};
    PulseSchedule schedule_{grid_, 1ms};
};

TEST_F(PulseScheduleTest, BeginsWithTheNextPulseOfTheGrid) {
    EXPECT_EQ(schedule_.next(at(k0) + 3ms, 0), k0 + 1);
}

TEST_F(PulseScheduleTest, WaitsForTheFirstPulseThatWasAnnounced) {
    EXPECT_EQ(schedule_.next(at(k0), k0 + 50), k0 + 50);
    EXPECT_TRUE(send(k0 + 50, 10us));
    EXPECT_EQ(schedule_.next(at(k0 + 50) + 1ms, k0 + 50), k0 + 51);
}

TEST_F(PulseScheduleTest, JoinsTheRunningIndexWhenTheFirstPulseHasPassed) {
    EXPECT_EQ(schedule_.next(at(k0 + 1000) + 1us, k0), k0 + 1001);
    EXPECT_EQ(schedule_.skipped(), 0u);
}

TEST_F(PulseScheduleTest, WaitsForNoFirstPulseAgainAfterTheClockWasSetBack) {
    EXPECT_EQ(schedule_.next(at(k0), k0 + 1), k0 + 1);
    EXPECT_TRUE(send(k0 + 1, 10us));
    constexpr std::uint64_t an_hour = 360'000;
    EXPECT_EQ(schedule_.next(at(k0 - an_hour), k0 + 1), k0 - an_hour + 1);
    EXPECT_TRUE(send(k0 - an_hour + 1, 10us));
    EXPECT_EQ(schedule_.next(at(k0 - an_hour + 1) + 1ms, k0 + 1), k0 - an_hour + 2);
}

TEST_F(PulseScheduleTest, SendsEveryPulseOnce) {
    TaiTime now = at(k0) - 1ms;
    for (std::uint64_t i = 0; i < 1000; ++i) {
        const std::uint64_t index = schedule_.next(now, 0);
        ASSERT_EQ(index, k0 + i);
        ASSERT_TRUE(send(index, 200us));
        now = at(index) + 300us;
    }
    EXPECT_EQ(schedule_.sent(), 1000u);
    EXPECT_EQ(schedule_.skipped(), 0u);
}

TEST_F(PulseScheduleTest, SkipsAndCountsAPulseThatWouldBeTooLate) {
    EXPECT_FALSE(send(k0, 1001us));
    EXPECT_TRUE(send(k0 + 1, 1000us));
    EXPECT_EQ(schedule_.sent(), 1u);
    EXPECT_EQ(schedule_.skipped(), 1u);
}

TEST_F(PulseScheduleTest, StillSendsOneThatIsALittleLate) {
    EXPECT_TRUE(send(k0, 0us));
    EXPECT_EQ(schedule_.next(at(k0 + 1) + 900us, 0), k0 + 1);
}

TEST_F(PulseScheduleTest, SkipsWhatPassedWhileTheComputerWasBusy) {
    EXPECT_TRUE(send(k0, 0us));
    EXPECT_EQ(schedule_.next(at(k0 + 5) + 5ms, 0), k0 + 6);
    EXPECT_EQ(schedule_.skipped(), 5u);
    EXPECT_TRUE(send(k0 + 6, 0us));
    EXPECT_EQ(schedule_.next(at(k0 + 8) + 500us, 0), k0 + 8) << "the newest is not too late yet";
    EXPECT_EQ(schedule_.skipped(), 6u);
}

TEST_F(PulseScheduleTest, FollowsAClockThatIsSet) {
    EXPECT_TRUE(send(k0, 0us));
    EXPECT_EQ(schedule_.next(at(k0 - 5000) + 1us, 0), k0 - 4999);
    EXPECT_TRUE(send(k0 - 4999, 0us));
    EXPECT_EQ(schedule_.next(at(k0 + 360'000) + 5ms, 0), k0 + 360'001);
    EXPECT_EQ(schedule_.clock_steps(), 2u);
    EXPECT_EQ(schedule_.skipped(), 0u);
}

TEST_F(PulseScheduleTest, DoesNotSendAheadOfTimeWhenTheClockIsSetBackInTheLastMoment) {
    EXPECT_FALSE(send(k0, -2ms));
}

}  // namespace
}  // namespace vantage
