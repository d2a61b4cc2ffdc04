#include <gtest/gtest.h>

#include "host_app/sound/sound_source.h"

namespace vantage {
namespace {

/// Sample n says so on both sides.
std::vector<float> numbered(std::int64_t first, std::size_t count) {
    std::vector<float> samples;
    for (std::size_t i = 0; i < count; ++i)
        samples.insert(samples.end(), 2, static_cast<float>(first + static_cast<std::int64_t>(i)));
    return samples;
}

TEST(SoundRing, ReturnsSilenceForMissingSamples) {
    SoundRing ring(10);
    EXPECT_EQ(ring.write(100, numbered(100, 4)), 4u);
    std::vector<float> got(2 * 6);
    EXPECT_EQ(ring.read(98, got), 4u);
    EXPECT_EQ(got, (std::vector<float>{0, 0, 0, 0, 100, 100, 101, 101, 102, 102, 103, 103}));
}

TEST(SoundRing, KeepsTheLatestAndFillsGaps) {
    SoundRing ring(10);
    ring.write(0, numbered(0, 7));
    EXPECT_EQ(ring.write(5, numbered(5, 4)), 2u) << "what was there already stays";
    ring.write(11, numbered(11, 3));
    EXPECT_EQ(ring.begin(), 4);
    EXPECT_EQ(ring.end(), 14);
    std::vector<float> got(2 * 10);
    EXPECT_EQ(ring.read(4, got), 10u);
    for (std::size_t i = 0; i < 10; ++i) {
        const std::size_t sample = 4 + i;
        const bool is_gap = sample == 9 || sample == 10;
        EXPECT_EQ(got[2 * i], is_gap ? 0.0F : static_cast<float>(sample)) << sample;
    }
    EXPECT_EQ(ring.read(0, got), 6u);
}

TEST(SoundRing, KeepsTheEndOfALongBlock) {
    SoundRing ring(10);
    ring.write(3, numbered(3, 25));
    std::vector<float> got(2 * 10);
    EXPECT_EQ(ring.read(18, got), 10u);
    EXPECT_EQ(got, numbered(18, 10));
    ring.write(1000, numbered(1000, 2));
    EXPECT_EQ(ring.begin(), 1000) << "nothing before it is left";
    EXPECT_EQ(ring.read(18, got), 0u);
}

}  // namespace
}  // namespace vantage
