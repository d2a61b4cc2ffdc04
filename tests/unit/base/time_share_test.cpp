#include "common/base/time_share.h"

#include <gtest/gtest.h>

using namespace std::chrono_literals;

namespace vantage {
namespace {

constexpr MonotonicTime start{10s};

TEST(TimeShare, IsEarnedByTheTimeThatPasses) {
    TimeShare share(0.5, 200ms, start);
    EXPECT_FALSE(share.has_some(start));
    EXPECT_TRUE(share.has_some(start + 20ms));
    share.spend(15ms);
    EXPECT_FALSE(share.has_some(start + 20ms));
    EXPECT_FALSE(share.has_some(start + 30ms));
    EXPECT_TRUE(share.has_some(start + 32ms));
}

TEST(TimeShare, OfWorkThatNeverEndsIsKept) {
    TimeShare share(0.75, 200ms, start);
    MonotonicTime now = start;
    std::chrono::nanoseconds worked{0};
    while (now < start + 100s) {
        if (share.has_some(now)) {
            share.spend(84ms);
            worked += 84ms;
            now += 84ms;
        } else {
            now += 1ms;
        }
    }
    EXPECT_NEAR(std::chrono::duration<double>(worked).count(), 75, 1);
}

TEST(TimeShare, CarriesSoMuchAndNoMore) {
    TimeShare share(0.5, 100ms, start);
    EXPECT_TRUE(share.has_some(start + 1h));
    share.spend(100ms);
    EXPECT_FALSE(share.has_some(start + 1h)) << "an hour left 100 ms";
    share.spend(1h);
    EXPECT_FALSE(share.has_some(start + 1h + 199ms));
    EXPECT_TRUE(share.has_some(start + 1h + 201ms)) << "an hour too much is 100 ms too much";
}

}  // namespace
}  // namespace vantage
