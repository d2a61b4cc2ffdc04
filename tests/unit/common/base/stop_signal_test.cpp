#include "common/base/cli/stop_signal.h"

#include <csignal>
#include <thread>

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
            std::this_thread::sleep_for(StopSignal::same_request);
            kill(getpid(), GetParam());
        },
        testing::KilledBySignal(GetParam()), "");
}

TEST_P(StopSignalTest, ASignalThatComesTwiceAtOnceIsOneRequest) {
    EXPECT_EXIT(
        {
            std::signal(GetParam(), SIG_DFL);
            {
                StopSignal stop;
                kill(getpid(), GetParam());
                stop.wait_for(10s);
                kill(getpid(), GetParam());
            }
            // The summary is printed when the loop that asked is over.
            kill(getpid(), GetParam());
            _exit(7);
        },
        testing::ExitedWithCode(7), "");
}

INSTANTIATE_TEST_SUITE_P(Signals, StopSignalTest, testing::Values(SIGINT, SIGTERM));

}  // namespace
}  // namespace vantage
