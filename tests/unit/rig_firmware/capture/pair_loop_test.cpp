#include "rig_firmware/capture/pair_loop.h"

#include <gtest/gtest.h>

namespace vantage {
namespace {

using namespace std::chrono_literals;

constexpr std::size_t pair_bytes = 2 * 3 * 17 * 11;

ColourImage picture(std::uint64_t seed) {
    ColourImage made(11, 17);
    cv::RNG random(seed);
    random.fill(made, cv::RNG::UNIFORM, 0, 256);
    for (cv::Vec4b& pixel : made) pixel[3] = 255;
    return made;
}
bool same(const ColourImage& a, const ColourImage& b) {
    return a.size() == b.size() && cv::norm(a, b, cv::NORM_INF) == 0;
}

TEST(PairLoop, ShowsAPairAgainWholeLoopsLaterToTheBit) {
    PairLoop loop({17, 11}, 24s, PulseGrid(5), 120 * pair_bytes);
    EXPECT_EQ(loop.room(), 120u);
    EXPECT_FALSE(loop.find(3s));
    loop.keep(3s, picture(1), picture(2));
    loop.keep(3200ms, picture(3), picture(4));
    for (const auto time : {3s, 27s, 24s * 100'000'000 + 3s, -21s}) {
        const auto pair = loop.find(time);
        ASSERT_TRUE(pair);
        EXPECT_TRUE(same(pair->left, picture(1)));
        EXPECT_TRUE(same(pair->right, picture(2)));
    }
    EXPECT_TRUE(same(loop.find(27200ms)->right, picture(4)));
    EXPECT_FALSE(loop.find(3400ms));
}

TEST(PairLoop, WhatIsFoundIsTheFindersOwn) {
    PairLoop loop({17, 11}, 24s, PulseGrid(5), 120 * pair_bytes);
    loop.keep(0s, picture(1), picture(2));
    loop.find(0s)->left.setTo(0);
    EXPECT_TRUE(same(loop.find(0s)->left, picture(1)));
}

TEST(PairLoop, KeepsWhatFitsAndNoMore) {
    PairLoop loop({17, 11}, 24s, PulseGrid(5), 2 * pair_bytes + pair_bytes / 2);
    EXPECT_EQ(loop.room(), 2u);
    for (int i = 0; i < 4; ++i) loop.keep(i * 200ms, picture(1), picture(2));
    EXPECT_EQ(loop.kept(), 2u);
    EXPECT_TRUE(loop.find(200ms));
    EXPECT_FALSE(loop.find(400ms));
    loop.keep(24s, picture(7), picture(8));
    EXPECT_EQ(loop.kept(), 2u) << "it is there already";
}

TEST(PairLoop, TakesNoMemoryWhereNoTimeComesTwice) {
    PairLoop loop({17, 11}, 24s, PulseGrid(29.97), 1000 * pair_bytes);
    EXPECT_EQ(loop.room(), 0u);
    loop.keep(0s, picture(1), picture(2));
    EXPECT_FALSE(loop.find(0s));
}

// The times of pulses are rounded to nanoseconds, and yet come again.
TEST(PairLoop, RepeatsAtRatesWhosePeriodIsNoWholeNumberOfNanoseconds) {
    const PulseGrid pulses(4.5);
    constexpr std::uint64_t length = 108, now = 8'000'000'007;
    PairLoop loop({17, 11}, 24s, pulses, length * pair_bytes);
    EXPECT_EQ(loop.length(), length);
    loop.keep(pulses.time_of(now % length).time_since_epoch(), picture(1), picture(2));
    EXPECT_TRUE(loop.find(pulses.time_of(now).time_since_epoch()));
    EXPECT_FALSE(loop.find(pulses.time_of(now + 1).time_since_epoch()));
}

TEST(PairLoop, KeepsNothingWithoutMemory) {
    PairLoop loop({17, 11}, 24s, PulseGrid(5), 0);
    loop.keep(0s, picture(1), picture(2));
    EXPECT_FALSE(loop.find(0s));
}

}  // namespace
}  // namespace vantage
