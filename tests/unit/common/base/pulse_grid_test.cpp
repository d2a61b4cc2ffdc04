#include "common/base/time/pulse_grid.h"

#include <gtest/gtest.h>

namespace vantage {
namespace {

using std::chrono::hours;
using std::chrono::nanoseconds;
using std::chrono::seconds;

constexpr TaiTime some_day = TaiTime(seconds(1'795'000'000));

TEST(PulseGrid, PutsPulsesOfWholeRatesOnWholeSeconds) {
    const PulseGrid grid(30);
    EXPECT_EQ(grid.time_of(0), TaiTime(seconds(0)));
    EXPECT_EQ(grid.time_of(30), TaiTime(seconds(1)));
    EXPECT_EQ(to_ns(grid.time_of(1)), 33'333'333);
    EXPECT_EQ(grid.time_of(30ull * 1'795'000'000), some_day) << "rounding must not add up";
    EXPECT_EQ(grid.period(), nanoseconds(33'333'333));
}

TEST(PulseGrid, KnowsBroadcastRates) {
    EXPECT_EQ(PulseGrid(29.97).time_of(30'000), TaiTime(seconds(1001)));
    EXPECT_EQ(PulseGrid(59.94).time_of(60'000), TaiTime(seconds(1001)));
    EXPECT_EQ(PulseGrid(23.976).time_of(24'000), TaiTime(seconds(1001)));
    EXPECT_EQ(PulseGrid(25).time_of(25'000), TaiTime(seconds(1000)));
    EXPECT_EQ(PulseGrid(12.5).time_of(25), TaiTime(seconds(2)));
    EXPECT_EQ(PulseGrid(0.01).time_of(1), TaiTime(seconds(100)));
}

TEST(PulseGrid, PulsesBeyondTheEndOfTimeAreAtItsEnd) {
    EXPECT_EQ(PulseGrid(0.5).time_of(53'000'000'000), TaiTime::max());
}

TEST(PulseGrid, ComputesThePulseOfATime) {
    for (const double rate_hz : {30.0, 29.97, 5.0, 119.88, 1000.0, 0.1}) {
        const PulseGrid grid(rate_hz);
        const std::uint64_t k = grid.index_at_or_before(some_day + hours(7));
        for (std::uint64_t i = k; i < k + 100; ++i) {
            EXPECT_EQ(grid.index_at_or_before(grid.time_of(i)), i) << rate_hz;
            EXPECT_EQ(grid.index_at_or_before(grid.time_of(i) - nanoseconds(1)), i - 1) << rate_hz;
            EXPECT_EQ(grid.nearest_index(grid.time_of(i) + grid.period() / 3), i) << rate_hz;
            EXPECT_EQ(grid.nearest_index(grid.time_of(i) - grid.period() / 3), i) << rate_hz;
        }
    }
}

}  // namespace
}  // namespace vantage
