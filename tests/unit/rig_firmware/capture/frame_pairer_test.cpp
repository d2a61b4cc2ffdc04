#include "rig_firmware/capture/frame_pairer.h"

#include <random>

#include <gtest/gtest.h>

namespace vantage {
namespace {

using std::chrono::milliseconds;
using Pairer = FramePairer<int>;

constexpr milliseconds period{10};
MonotonicTime at(double ms) {
    return MonotonicTime(std::chrono::nanoseconds(static_cast<std::int64_t>(ms * 1e6)));
}

TEST(FramePairer, JoinsWhatWasSeenAtOnce) {
    Pairer pairer(period);
    EXPECT_FALSE(pairer.pop());
    pairer.push_left(at(100), 1);
    EXPECT_FALSE(pairer.pop());
    pairer.push_right(at(101), 11);
    const auto pair = pairer.pop();
    ASSERT_TRUE(pair);
    EXPECT_EQ(pair->left.picture, 1);
    EXPECT_EQ(pair->right.picture, 11);
    EXPECT_FALSE(pairer.pop());
    EXPECT_EQ(pairer.unpaired(), 0u);
}

TEST(FramePairer, NeverJoinsByArrival) {
    Pairer pairer(period);
    pairer.push_left(at(100), 1);
    pairer.push_right(at(110), 12);
    EXPECT_FALSE(pairer.pop()) << "the next instant of the other side";
    pairer.push_left(at(110.5), 2);
    const auto pair = pairer.pop();
    ASSERT_TRUE(pair);
    EXPECT_EQ(pair->left.picture, 2);
    EXPECT_EQ(pair->right.picture, 12);
    EXPECT_EQ(pairer.unpaired(), 1u);
}

TEST(FramePairer, RefusesHalfAPeriodApart) {
    Pairer pairer(period);
    pairer.push_left(at(100), 1);
    pairer.push_right(at(105), 11);
    EXPECT_FALSE(pairer.pop());
    pairer.push_right(at(95.1), 10);
    EXPECT_FALSE(pairer.pop()) << "the left one is gone";
}

TEST(FramePairer, FindsItsWayThroughGapsJitterAndOffsetStarts) {
    // Both sides lose every seventh or eleventh picture, and the right begins 3 instants later.
    Pairer pairer(period);
    std::mt19937 random(5);
    std::uniform_real_distribution<double> jitter(-2, 2);
    int pairs = 0, wanted = 0, lost = 0;
    for (int k = 0; k < 1000; ++k) {
        const bool left = k % 7 != 0, right = k >= 3 && k % 11 != 0;
        if (left) pairer.push_left(at(1000 + 10 * k + jitter(random)), k);
        if (right) pairer.push_right(at(1000 + 10 * k + jitter(random)), k);
        wanted += left && right;
        lost += left != right;
        while (const auto pair = pairer.pop()) {
            EXPECT_EQ(pair->left.picture, pair->right.picture);
            ++pairs;
        }
    }
    EXPECT_EQ(pairs, wanted);
    pairer.clear();
    EXPECT_EQ(pairer.unpaired(), static_cast<std::uint64_t>(lost));
}

TEST(FramePairer, TakesABurstOfOneSideAfterTheOther) {
    Pairer pairer(period);
    for (int k = 0; k < 3; ++k) pairer.push_left(at(10 * k), k);
    for (int k = 0; k < 3; ++k) pairer.push_right(at(10 * k + 1), k);
    for (int k = 0; k < 3; ++k) {
        const auto pair = pairer.pop();
        ASSERT_TRUE(pair);
        EXPECT_EQ(pair->left.picture, k);
        EXPECT_EQ(pair->right.picture, k);
    }
}

TEST(FramePairer, StaysBoundedWhileOneSideIsSilent) {
    Pairer pairer(period);
    for (int k = 0; k < 1000; ++k) pairer.push_left(at(10 * k), k);
    EXPECT_GE(pairer.unpaired(), 990u);
    pairer.clear();
    EXPECT_EQ(pairer.unpaired(), 1000u);
}

}  // namespace
}  // namespace vantage
