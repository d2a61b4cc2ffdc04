#include "common/base/cli/stop_signal.h"

#include <csignal>

#include <gtest/gtest.h>
#include <unistd.h>

namespace vantage {
namespace {

using namespace std::chrono_literals;

class StopSignalTest : public testing::TestWithParam<int> {};

TEST_P(StopSignalTest, ReportsTheRequestToStop) {
    StopSignal stop;
    EXPECT_FALSE(stop.requested());
    EXPECT_FALSE(stop.wait_for(1ms));
    kill(getpid(), GetParam());
    EXPECT_TRUE(stop.wait_for(10s));
    EXPECT_TRUE(stop.requested()) << "for good";
}

TEST_P(StopSignalTest, ASecondSignalEndsTheProgram) {
    EXPECT_EXIT(
        {
            // A shell starts what runs in the background with SIGINT ignored.
            std::signal(GetParam(), SIG_DFL);
            StopSignal stop;
            kill(getpid(), GetParam());
            stop.wait_for(10s);
            kill(getpid(), GetParam());
        },
        testing::KilledBySignal(GetParam()), "");
}

INSTANTIATE_TEST_SUITE_P(Signals, StopSignalTest, testing::Values(SIGINT, SIGTERM));

}  // namespace
}  // namespace vantage
