#include "host_app/programme/tick_clock.h"

#include <gtest/gtest.h>

namespace vantage {
namespace {

using namespace std::chrono_literals;

constexpr MonotonicTime start{1'000'000'000ns};

TEST(TickClock, TicksAtTheRate) {
    TickClock clock(25, start);
    EXPECT_EQ(clock.until_next(start), 0ns);
    EXPECT_EQ(clock.next_tick(start), 0u);
    EXPECT_EQ(clock.until_next(start + 1ms), 39ms);
    EXPECT_EQ(clock.next_tick(start + 40ms), 1u);
    EXPECT_EQ(clock.time_of(7), 280ms);
}

TEST(TickClock, SkipsTicksThatALateFrameMisses) {
    TickClock clock(25, start);
    EXPECT_EQ(clock.next_tick(start), 0u);
    EXPECT_EQ(clock.next_tick(start + 130ms), 3u);
    EXPECT_EQ(clock.next_tick(start + 160ms), 4u);
}

TEST(TickClock, NeverReturnsATickTwice) {
    TickClock clock(25, start);
    EXPECT_EQ(clock.next_tick(start), 0u);
    EXPECT_EQ(clock.next_tick(start + 1ms), 1u);
    EXPECT_EQ(clock.next_tick(start + 2ms), 2u);
}

TEST(TickClock, KeepsABroadcastRateForADay) {
    const double rate_hz = 30000.0 / 1001;
    TickClock clock(rate_hz, start);
    const std::uint64_t day = 2'589'408;  // whole ticks of 86400 s - 0.0136 s
    EXPECT_NEAR(static_cast<double>(clock.time_of(day).count()),
                static_cast<double>(day) * 1001 / 30000 * 1e9, 100);
    // A call exactly when a tick is due returns that tick.
    for (std::uint64_t tick = day; tick < day + 100; ++tick)
        EXPECT_EQ(clock.next_tick(start + clock.time_of(tick)), tick);
}

}  // namespace
}  // namespace vantage
