#include "rig_firmware/daemon/rig_daemon.h"

#include <chrono>
#include <thread>

#include <gtest/gtest.h>

#include "common/base/error.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;

RigConfig small_rig() {
    RigConfig config;
    config.name = "test";
    config.source.width_px = 61;
    config.source.height_px = 47;
    config.source.rate_hz = 200;  // more than any processor renders
    config.match.disparities = 16;
    config.stream.bind = "tcp://127.0.0.1:*";
    return config;
}

TEST(RigDaemon, AccountsForEveryFrameAtItsStop) {
    RigDaemon daemon(small_rig(), 5);
    while (daemon.running()) std::this_thread::sleep_for(5ms);
    daemon.stop();
    daemon.rethrow_failure();
    const DaemonStatus status = daemon.status();
    const RigCounters& counters = status.publisher.counters;
    EXPECT_EQ(counters.published, 5u);
    EXPECT_EQ(counters.captured, counters.published + counters.late);
    EXPECT_EQ(status.latency_ms.count, 5u);
    EXPECT_GT(status.latency_ms.p50, status.match_ms.p50);
}

TEST(RigDaemon, CanBeStoppedAtAnyTime) {
    for (const auto after : {0ms, 3ms, 40ms, 150ms}) {
        RigDaemon daemon(small_rig());
        std::this_thread::sleep_for(after);
        daemon.stop();
        daemon.rethrow_failure();
        const RigCounters counters = daemon.status().publisher.counters;
        EXPECT_EQ(counters.captured, counters.published + counters.late);
        EXPECT_FALSE(daemon.running());
    }
}

TEST(RigDaemon, SaysWhyItCannotStand) {
    RigConfig config = small_rig();
    config.match.matcher = "none such";
    EXPECT_THROW(RigDaemon{config}, Error);
    config = small_rig();
    config.source.kind = "files";
    EXPECT_THROW(RigDaemon{config}, Error);
}

}  // namespace
}  // namespace vantage
