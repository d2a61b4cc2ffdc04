#include "common/base/latest_value.h"

#include <array>
#include <thread>

#include <gtest/gtest.h>

namespace vantage {
namespace {

TEST(LatestValue, GivesTheNewestOnce) {
    LatestValue<int> value;
    EXPECT_EQ(value.take(), nullptr);
    value.give(1);
    value.give(2);
    value.give(3);
    const int* taken = value.take();
    ASSERT_NE(taken, nullptr);
    EXPECT_EQ(*taken, 3);
    EXPECT_EQ(value.take(), nullptr);
    value.give(4);
    value.give(5);
    EXPECT_EQ(*taken, 3) << "valid until the next is taken";
    ASSERT_NE(taken = value.take(), nullptr);
    EXPECT_EQ(*taken, 5);
}

TEST(LatestValue, IsWholeAndInOrderBetweenThreads) {
    constexpr int last = 100'000;
    LatestValue<std::array<int, 32>> value;
    std::thread giver([&] {
        for (int i = 1; i <= last; ++i) {
            std::array<int, 32> all;
            all.fill(i);
            value.give(all);
        }
    });
    int newest = 0, torn = 0, backward = 0;
    while (newest < last) {
        const std::array<int, 32>* taken = value.take();
        if (!taken) {
            std::this_thread::yield();
            continue;
        }
        backward += taken->front() <= newest;
        newest = taken->front();
        for (const int each : *taken) torn += each != newest;
    }
    giver.join();
    EXPECT_EQ(torn, 0);
    EXPECT_EQ(backward, 0);
}

}  // namespace
}  // namespace vantage
