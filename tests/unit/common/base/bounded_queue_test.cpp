#include "common/base/bounded_queue.h"

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace vantage {
namespace {

using namespace std::chrono_literals;

TEST(BoundedQueue, ReturnsItemsInOrder) {
    BoundedQueue<int> queue(3);
    EXPECT_FALSE(queue.push(1));
    EXPECT_FALSE(queue.push(2));
    EXPECT_EQ(queue.size(), 2u);
    EXPECT_EQ(queue.pop_for(0ns), 1);
    EXPECT_EQ(queue.pop_for(0ns), 2);
    EXPECT_EQ(queue.dropped_count(), 0u);
}

TEST(BoundedQueue, DropsTheOldestAndCountsIt) {
    BoundedQueue<int> queue(2);
    queue.push(1);
    queue.push(2);
    EXPECT_EQ(queue.push(3), 1) << "the one that made room comes back";
    EXPECT_EQ(queue.push(4), 2);
    EXPECT_EQ(queue.size(), 2u);
    EXPECT_EQ(queue.dropped_count(), 2u);
    EXPECT_EQ(queue.pop_for(0ns), 3);
    EXPECT_EQ(queue.pop_for(0ns), 4);
}

TEST(BoundedQueue, HoldsOneItemAtLeast) {
    BoundedQueue<int> queue(0);
    EXPECT_FALSE(queue.push(1));
    EXPECT_EQ(queue.push(2), 1);
}

TEST(BoundedQueue, PopReturnsEmptyAfterTheTimeout) {
    BoundedQueue<int> queue(2);
    const auto before = std::chrono::steady_clock::now();
    EXPECT_FALSE(queue.pop_for(20ms));
    EXPECT_GE(std::chrono::steady_clock::now() - before, 20ms);
}

TEST(BoundedQueue, CanBeDrainedAfterCloseAndAcceptsNothing) {
    BoundedQueue<std::unique_ptr<int>> queue(4);
    queue.push(std::make_unique<int>(7));
    queue.close();
    EXPECT_TRUE(queue.closed());
    const auto refused = queue.push(std::make_unique<int>(8));
    ASSERT_TRUE(refused);
    EXPECT_EQ(**refused, 8) << "the caller keeps what was not taken";
    EXPECT_EQ(queue.dropped_count(), 0u);
    const auto last = queue.pop_for(1h);
    ASSERT_TRUE(last);
    EXPECT_EQ(**last, 7);
    EXPECT_FALSE(queue.pop_for(1h)) << "at once, not after an hour";
}

TEST(BoundedQueue, CloseWakesAWaitingReader) {
    BoundedQueue<int> queue(1);
    std::optional<int> got = 5;
    std::thread reader([&] { got = queue.pop_for(1h); });
    queue.close();
    reader.join();
    EXPECT_FALSE(got);
}

TEST(BoundedQueue, EveryItemIsReadOrCountedAsDroppedBetweenThreads) {
    constexpr int pushed = 20000;
    BoundedQueue<int> queue(8);
    std::vector<int> read;
    std::thread reader([&] {
        while (true) {
            const auto item = queue.pop_for(1h);
            if (!item) return;
            read.push_back(*item);
        }
    });
    for (int i = 0; i < pushed; ++i) queue.push(i);
    queue.close();
    reader.join();
    EXPECT_EQ(read.size() + queue.dropped_count(), static_cast<std::size_t>(pushed));
    EXPECT_TRUE(std::is_sorted(read.begin(), read.end()));
    ASSERT_FALSE(read.empty());
    EXPECT_EQ(read.back(), pushed - 1) << "the newest is never the one dropped";
}

TEST(BoundedQueue, WaitsForRoom) {
    BoundedQueue<int> queue(1);
    EXPECT_TRUE(queue.wait_for_room(0ns));
    queue.push(1);
    EXPECT_FALSE(queue.wait_for_room(1ms));
    std::thread reader([&] { queue.pop_for(1h); });
    EXPECT_TRUE(queue.wait_for_room(1h));
    reader.join();
    queue.push(2);
    std::thread inpainting([&] { queue.close(); });
    EXPECT_FALSE(queue.wait_for_room(1h));
    inpainting.join();
}

}  // namespace
}  // namespace vantage
