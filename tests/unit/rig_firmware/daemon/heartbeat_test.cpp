#include "rig_firmware/daemon/heartbeat.h"

#include <gtest/gtest.h>

namespace vantage {
namespace {

using namespace std::chrono_literals;

TEST(Heartbeat, IsSilentSinceItsLastBeatAndNeverWhileItRests) {
    const MonotonicTime start = monotonic_from_ns(1'000'000'000);
    Heartbeat heart("gpu");
    EXPECT_EQ(heart.worker(), "gpu");
    EXPECT_EQ(heart.silence(start + 1h), 0ns) << "it has not begun";
    heart.beat(start);
    EXPECT_EQ(heart.silence(start + 20s), 20s);
    heart.beat(start + 15s);
    EXPECT_EQ(heart.silence(start + 20s), 5s);
    heart.rest();
    EXPECT_EQ(heart.silence(start + 1h), 0ns);
}

}  // namespace
}  // namespace vantage
