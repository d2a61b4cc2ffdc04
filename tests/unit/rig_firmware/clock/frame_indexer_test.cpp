#include "rig_firmware/clock/frame_indexer.h"

#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "rig_firmware/clock/clock_model.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;

constexpr std::uint64_t k0 = 53'850'000'000;
constexpr std::chrono::nanoseconds delay = 6ms;

class FrameIndexerTest : public testing::Test {
  protected:
    TaiTime stamp(std::uint64_t index, std::chrono::nanoseconds off = 0ns) const {
        return grid_.time_of(index) + delay + off;
    }
    void send(std::uint64_t first, std::uint64_t end) {
        for (std::uint64_t i = first; i < end; ++i) indexer_.sent(i);
    }

    PulseGrid grid_{30};
    FrameIndexer indexer_{grid_, delay};
};

TEST_F(FrameIndexerTest, GivesAFrameTheIndexOfItsPulseWhateverItsJitter) {
    std::mt19937 random(1);
    std::uniform_int_distribution<int> jitter(-4'000'000, 4'000'000);
    for (std::uint64_t i = 0; i < 1000; ++i) {
        indexer_.sent(k0 + i);
        ASSERT_EQ(indexer_.index_of(stamp(k0 + i, std::chrono::nanoseconds(jitter(random)))),
                  k0 + i);
    }
    EXPECT_EQ(indexer_.missed(), 0u);
}

TEST_F(FrameIndexerTest, DoesNotCountFrames) {
    send(k0, k0 + 10);
    // The camera begins with the third pulse, leaves two out, and delivers in a burst.
    EXPECT_EQ(indexer_.index_of(stamp(k0 + 2)), k0 + 2);
    EXPECT_EQ(indexer_.index_of(stamp(k0 + 5)), k0 + 5);
    EXPECT_EQ(indexer_.index_of(stamp(k0 + 6)), k0 + 6);
    EXPECT_EQ(indexer_.missed(), 2u);
}

TEST_F(FrameIndexerTest, MarksAFrameWithoutPulse) {
    send(k0, k0 + 2);
    EXPECT_EQ(indexer_.index_of(stamp(k0 + 1)), k0 + 1);
    EXPECT_EQ(indexer_.index_of(stamp(k0 + 2)), std::nullopt) << "this pulse was skipped";
    EXPECT_EQ(indexer_.index_of(stamp(k0 + 1, 15ms)), std::nullopt) << "between two pulses";
    EXPECT_EQ(indexer_.unsynchronized(), 2u);
}

TEST_F(FrameIndexerTest, GivesEveryPulseOnce) {
    send(k0, k0 + 3);
    EXPECT_EQ(indexer_.index_of(stamp(k0)), k0);
    EXPECT_EQ(indexer_.index_of(stamp(k0, 1ms)), std::nullopt);
    EXPECT_EQ(indexer_.duplicates(), 1u);
    EXPECT_EQ(indexer_.index_of(stamp(k0 + 1)), k0 + 1);
}

TEST_F(FrameIndexerTest, NumbersTheEdgesOfAnotherRigsWireByTheGrid) {
    EXPECT_TRUE(indexer_.seen(grid_.time_of(k0) + 100us));
    EXPECT_TRUE(indexer_.seen(grid_.time_of(k0 + 1) - 50us));
    EXPECT_FALSE(indexer_.seen(grid_.time_of(k0 + 1) + 12ms)) << "a spike on the wire";
    EXPECT_EQ(indexer_.stray_edges(), 1u);
    EXPECT_EQ(indexer_.index_of(stamp(k0)), k0);
    EXPECT_EQ(indexer_.index_of(stamp(k0 + 1)), k0 + 1);
}

TEST_F(FrameIndexerTest, GoesBackWithAClockThatWasSet) {
    send(k0, k0 + 2);
    EXPECT_EQ(indexer_.index_of(stamp(k0 + 1)), k0 + 1);
    send(k0 - 5000, k0 - 4998);
    EXPECT_EQ(indexer_.index_of(stamp(k0 - 5000)), k0 - 5000);
    EXPECT_EQ(indexer_.missed(), 0u);
}

/// A sensor whose own clock runs 100 ppm fast, for a day: the model and the indexer together.
TEST_F(FrameIndexerTest, HoldsForADayWithAClockThatRuns100PpmFast) {
    ClockModel model;
    std::mt19937 random(2);
    std::uniform_int_distribution<int> jitter(-50'000, 50'000);
    const TaiTime begin = grid_.time_of(k0);
    const auto sensor_clock = [&](TaiTime t) {
        const auto since = (t - begin).count();
        return monotonic_from_ns(7'000'000'000 + since + since / 10'000);
    };
    constexpr std::uint64_t pulses_a_day = 30ull * 86'400;
    std::uint64_t wrong = 0, asked = 0;
    for (std::uint64_t i = 0; i < pulses_a_day; ++i) {
        const TaiTime pulse = grid_.time_of(k0 + i);
        if (i % 30 == 0)
            model.observe(sensor_clock(pulse), pulse + std::chrono::nanoseconds(jitter(random)));
        indexer_.sent(k0 + i);
        if (i % 997 == 5) continue;  // a frame is lost now and then
        const TaiTime exposed = pulse + delay + std::chrono::nanoseconds(jitter(random));
        wrong += indexer_.index_of(model.to_tai(sensor_clock(exposed))) != k0 + i;
        ++asked;
    }
    EXPECT_EQ(wrong, 0u);
    EXPECT_EQ(indexer_.missed(), pulses_a_day - asked);
    EXPECT_EQ(model.state().steps, 0u);
}

TEST_F(FrameIndexerTest, CountsPulsesOfTheStageWhoseEdgeDidNotCome) {
    for (const std::uint64_t i : {0u, 1u, 4u, 4u, 5u})
        EXPECT_TRUE(indexer_.seen(grid_.time_of(k0 + i)));
    EXPECT_FALSE(indexer_.seen(grid_.time_of(k0 + 6) + grid_.period() / 2));
    EXPECT_EQ(indexer_.missing_edges(), 2u);
    EXPECT_EQ(indexer_.stray_edges(), 1u);
}

}  // namespace
}  // namespace vantage
