#include "host_app/surfaces/recycle_pool.h"

#include <optional>
#include <thread>

#include <gtest/gtest.h>

namespace vantage {
namespace {

/// Counts its objects.
struct Counted {
    Counted() { ++made, ++alive; }
    ~Counted() { --alive; }
    Counted(const Counted&) = delete;
    Counted& operator=(const Counted&) = delete;

    int mark = 0;
    static inline int made = 0, alive = 0;
};

class RecyclePoolTest : public testing::Test {
  protected:
    RecyclePoolTest() { Counted::made = Counted::alive = 0; }
};

TEST_F(RecyclePoolTest, ReusesAFreeObjectWithItsContent) {
    RecyclePool<Counted> pool;
    const std::shared_ptr<Counted> held = pool.take();
    for (int i = 0; i < 10; ++i) {
        const std::shared_ptr<Counted> one = pool.take();
        EXPECT_EQ(one->mark, i);
        ++one->mark;
    }
    EXPECT_EQ(held->mark, 0);
    EXPECT_EQ(Counted::made, 2);
}

TEST_F(RecyclePoolTest, NeverHandsOutAnObjectThatIsHeld) {
    RecyclePool<Counted> pool;
    std::shared_ptr<const Counted> kept = pool.take();
    const std::shared_ptr<const Counted> copy = kept;
    kept.reset();
    EXPECT_NE(pool.take().get(), copy.get());
}

TEST_F(RecyclePoolTest, DropsItsFreeObjectsOnly) {
    RecyclePool<Counted> pool;
    const std::shared_ptr<Counted> held = pool.take();
    (void)pool.take();
    ASSERT_EQ(Counted::alive, 2);
    pool.drop_free();
    EXPECT_EQ(Counted::alive, 1);
    (void)pool.take();
    EXPECT_EQ(Counted::alive, 2);
}

TEST_F(RecyclePoolTest, AcceptsObjectsFromAnyThread) {
    RecyclePool<Counted> pool;
    for (int round = 0; round < 50; ++round) {
        std::thread one([held = pool.take()]() mutable { held.reset(); });
        std::thread other([held = pool.take()]() mutable { held.reset(); });
        one.join();
        other.join();
    }
    EXPECT_EQ(Counted::made, 2);
}

TEST_F(RecyclePoolTest, DestroysFreeObjectsWithItselfAndHeldOnesWhenReleased) {
    std::optional<RecyclePool<Counted>> pool(std::in_place);
    std::shared_ptr<Counted> longer = pool->take();
    pool->take();
    EXPECT_EQ(Counted::alive, 2);
    pool.reset();
    EXPECT_EQ(Counted::alive, 1);
    longer.reset();
    EXPECT_EQ(Counted::alive, 0);
}

}  // namespace
}  // namespace vantage
