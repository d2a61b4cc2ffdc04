#include "common/base/time/time_budget.h"

#include <gtest/gtest.h>

using namespace std::chrono_literals;

namespace vantage {
namespace {

constexpr MonotonicTime start{10s};

TEST(TimeBudget, AccumulatesWithTime) {
    TimeBudget share(0.5, 200ms, start);
    EXPECT_FALSE(share.has_some(start));
    EXPECT_TRUE(share.has_some(start + 20ms));
    share.spend(15ms);
    EXPECT_FALSE(share.has_some(start + 20ms));
    EXPECT_FALSE(share.has_some(start + 30ms));
    EXPECT_TRUE(share.has_some(start + 32ms));
}

TEST(TimeBudget, LimitsContinuousWorkToItsShare) {
    for (const std::chrono::milliseconds work : {84ms, 370ms}) {
        TimeBudget share(0.75, 200ms, start);
        MonotonicTime now = start;
        std::chrono::nanoseconds worked{0};
        while (now < start + 100s) {
            const bool has_some = share.has_some(now);
            now += has_some ? work : 1ms;
            if (!has_some) continue;
            share.spend(work);
            worked += work;
        }
        EXPECT_NEAR(std::chrono::duration<double>(worked).count(), 75, 1) << work.count() << " ms";
    }
}

TEST(TimeBudget, CarriesOverALimitedAmount) {
    TimeBudget share(0.5, 100ms, start);
    MonotonicTime now = start + 1h;
    EXPECT_TRUE(share.has_some(now));
    share.spend(100ms);
    EXPECT_FALSE(share.has_some(now)) << "an hour left 100 ms";
    now += 1h;
    share.spend(1h);
    EXPECT_FALSE(share.has_some(now));
    EXPECT_FALSE(share.has_some(now + 199ms));
    EXPECT_TRUE(share.has_some(now + 201ms)) << "half an hour too much is 100 ms too much";
}

}  // namespace
}  // namespace vantage
