#include "host_app/programme/stats/input_latency.h"

#include <gtest/gtest.h>

namespace vantage {
namespace {

using namespace std::chrono_literals;

const MonotonicTime began{1h};

TEST(InputLatency, MeasuresFromTheEarliestInputToTheFirstFrameWithIt) {
    InputLatency watch;
    watch.saw(began, 3, true);
    watch.saw(began + 40ms, 4, true);
    watch.showed(2, 2, began + 50ms);
    EXPECT_TRUE(watch.is_waiting());
    EXPECT_FALSE(watch.is_waiting_for_rendering());
    EXPECT_EQ(watch.all_ms().count, 0u) << "a frame from before the input";
    watch.showed(4, 4, began + 90ms);
    EXPECT_EQ(watch.all_ms().count, 1u);
    EXPECT_DOUBLE_EQ(watch.all_ms().max, 90);
    watch.showed(5, 5, began + 130ms);
    EXPECT_EQ(watch.all_ms().count, 1u) << "one frame showed both";
}

TEST(InputLatency, ReprojectionShowsInputThatOnlyFlies) {
    InputLatency watch;
    watch.saw(began, 3, true);
    watch.saw(began + 1ms, 4, false);
    watch.showed(4, 2, began + 50ms);
    EXPECT_EQ(watch.all_ms().count, 1u);
    EXPECT_DOUBLE_EQ(watch.all_ms().max, 50);
    EXPECT_TRUE(watch.is_waiting_for_rendering());
    watch.showed(5, 4, began + 101ms);
    EXPECT_FALSE(watch.is_waiting());
    EXPECT_EQ(watch.all_ms().count, 2u) << "other input waits for a rendered frame";
    EXPECT_DOUBLE_EQ(watch.all_ms().max, 100);
}

TEST(InputLatency, IgnoresInputThatChangesNoFrame) {
    InputLatency watch;
    watch.saw(began, 3, true);
    watch.drop();
    watch.showed(4, 4, began + 50ms);
    EXPECT_EQ(watch.all_ms().count, 0u);
}

TEST(InputLatency, KeepsTheEarliestInputsWithinItsBound) {
    InputLatency watch;
    for (int i = 0; i < 100'000; ++i)
        watch.saw(began + std::chrono::milliseconds(i), static_cast<std::uint64_t>(i), true);
    watch.showed(100'000, 100'000, began + 200s);
    EXPECT_DOUBLE_EQ(watch.all_ms().max, 200'000) << "the earliest counts";
}

}  // namespace
}  // namespace vantage
