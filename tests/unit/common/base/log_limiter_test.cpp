#include "common/base/log_limiter.h"

#include <gtest/gtest.h>

namespace vantage {
namespace {

using namespace std::chrono_literals;

TEST(LogLimiter, ReportsTheFirstEventAtOnceAndFurtherOnesTogether) {
    LogLimiter limiter(10s);
    const MonotonicTime start = monotonic_from_ns(0) + 1h;
    EXPECT_EQ(limiter.count(0, start), std::nullopt);
    EXPECT_EQ(limiter.count(1, start), 1u);
    for (int i = 0; i < 100; ++i) EXPECT_EQ(limiter.count(1, start + 5s), std::nullopt);
    EXPECT_EQ(limiter.count(0, start + 10s), 100u) << "also when nothing more comes";
    EXPECT_EQ(limiter.count(0, start + 30s), std::nullopt);
    EXPECT_EQ(limiter.count(2, start + 30s), 2u);
}

}  // namespace
}  // namespace vantage
