#include <gtest/gtest.h>

#include "host_app/takes/rig_fetch.h"

namespace vantage {
namespace {

using Parts = std::vector<PulseRange>;

TEST(PulseRangeTest, ComputesMissingParts) {
    const auto missing = [](PulseRange whole, std::vector<std::uint64_t> there) {
        return missing_parts(whole, there);
    };
    EXPECT_EQ(missing({10, 20}, {}), (Parts{{10, 20}}));
    EXPECT_EQ(missing({10, 20}, {10, 11, 15, 19}), (Parts{{12, 15}, {16, 19}}));
    EXPECT_EQ(missing({10, 20}, {3, 12, 12, 25}), (Parts{{10, 12}, {13, 20}}));
    EXPECT_EQ(missing({10, 12}, {9, 10, 11, 12}), Parts{});
    EXPECT_EQ(missing({10, 10}, {}), Parts{});
}

TEST(BandwidthBudgetTest, LimitsTheLongTermRate) {
    BandwidthBudget budget(1e6);
    MonotonicTime now = monotonic_from_ns(1'000'000'000);
    double spent = 0;
    for (int ms = 0; ms < 10'000; ++ms, now += std::chrono::milliseconds(1))
        while (budget.may_spend(now)) {
            budget.spend(30e3);
            spent += 30e3;
        }
    EXPECT_GE(spent, 9.9e6);
    EXPECT_LE(spent, 10.3e6);
    EXPECT_GT(budget.wait(now).count(), 0);
    now += budget.wait(now);
    EXPECT_TRUE(budget.may_spend(now + std::chrono::nanoseconds(10)));
}

TEST(BandwidthBudgetTest, APauseSavesAtMostAQuarterOfASecond) {
    BandwidthBudget budget(1e6);
    MonotonicTime now = monotonic_from_ns(1'000'000'000);
    budget.may_spend(now);
    now += std::chrono::hours(1);
    double spent = 0;
    while (budget.may_spend(now)) {
        budget.spend(10e3);
        spent += 10e3;
    }
    EXPECT_LE(spent, 0.27e6);
}

}  // namespace
}  // namespace vantage
