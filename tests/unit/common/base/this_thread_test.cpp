#include "common/base/this_thread.h"

#include <thread>

#include <gtest/gtest.h>
#include <sched.h>

namespace vantage {
namespace {

TEST(ThisThread, IdleSchedulingAppliesToTheCallingThreadOnly) {
    int policy = -1;
    std::thread([&] {
        make_this_thread_idle();
        policy = ::sched_getscheduler(0);
    }).join();
    EXPECT_EQ(policy, SCHED_IDLE);
    EXPECT_NE(::sched_getscheduler(0), SCHED_IDLE) << "who began it";
}

}  // namespace
}  // namespace vantage
