#include "tests/faults/hostile_rig.h"

#include <fstream>
#include <memory>

#include <gtest/gtest.h>
#include <unistd.h>

#include "common/base/log.h"
#include "common/receive/stage_receiver.h"
#include "rig_firmware/stream/publisher.h"
#include "tests/support/data_folder.h"
#include "tests/support/eventually.h"
#include "tests/support/wire_frames.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;

double resident_mb() {
    std::size_t total = 0, resident = 0;
    std::ifstream("/proc/self/statm") >> total >> resident;
    return 1e-6 * static_cast<double>(resident * static_cast<std::size_t>(::getpagesize()));
}

/// A host with two honest rigs and a hostile one.
class HostileRigs : public testing::TestWithParam<unsigned> {
  protected:
    static std::unique_ptr<Publisher> honest_rig(const std::string& name) {
        RigConfig::Stream stream;
        stream.bind = "tcp://127.0.0.1:*";
        return std::make_unique<Publisher>(stream, name);
    }

    TemporaryFolder folder_;
};

INSTANTIATE_TEST_SUITE_P(Seeds, HostileRigs, testing::Values(1u, 2u, 3u));

TEST_P(HostileRigs, CostTheOtherRigsNoFrame) {
    write_key_file(folder_.path() / "host.key", generate_curve_keys());
    const std::unique_ptr<Publisher> left = honest_rig("left"), right = honest_rig("right");
    constexpr std::chrono::nanoseconds period = 40ms;
    const std::string name = "hostile-" + std::to_string(GetParam());
    HostileRig hostile(name, period, GetParam());
    StageConfig stage;
    stage.key_file = folder_.path() / "host.key";
    stage.rate_hz = 25;
    // A busy computer is no rig that is late.
    stage.latency_budget_ms = 10000;
    stage.rigs = {{"left", left->endpoint(), ""}, {"right", right->endpoint(), ""}};
    StageReceiver host(stage);
    ASSERT_TRUE(eventually([&] {
        const auto rigs = host.status().rigs;
        return rigs[0].connected && rigs[1].connected;
    }));
    const double resident_before_mb = resident_mb();
    double most_mb = resident_before_mb;
    std::uint64_t honest_frames = 0, pulse = 0;
    constexpr std::uint64_t honest_start = 5, messages = 3000;
    while (hostile.sent() < messages && !HasFailure()) {
        const auto now = static_cast<std::uint64_t>(TaiClock::now().time_since_epoch() / period);
        if (now > pulse) {
            pulse = now;
            ++honest_frames;
            for (Publisher* rig : {left.get(), right.get()}) rig->publish(make_frame(pulse));
            // None is dropped because this test, which is no rig, publishes faster than it is read.
            ASSERT_TRUE(eventually([&] {
                const auto rigs = host.status().rigs;
                return rigs[0].received == honest_frames && rigs[1].received == honest_frames;
            }));
            // From here on the two outvote the third.
            if (honest_frames == honest_start) {
                stage.rigs.push_back({name, hostile.endpoint(), hostile.public_key()});
                host.follow(host.prepare(stage));
            }
        }
        while (host.next(0s)) {
        }
        most_mb = std::max(most_mb, resident_mb());
    }
    const std::vector<RigStatus> rigs = host.status().rigs;
    for (const std::size_t honest : {0, 1}) {
        const RigStatus& rig = rigs[honest];
        EXPECT_EQ(rig.received, honest_frames);
        EXPECT_EQ(rig.lost, 0u);
        EXPECT_EQ(rig.queue_dropped, 0u);
        EXPECT_EQ(rig.undecodable, 0u);
        EXPECT_EQ(rig.outages, 0u);
        EXPECT_EQ(rig.out_of_step + rig.duplicate + rig.unsynchronized, 0u);
        // The first frame of one may come before the other one is in play.
        EXPECT_LE(rig.late, 1u);
        EXPECT_EQ(trouble_of(rig), "");
    }
    EXPECT_GT(rigs[2].undecodable, 0u);
    EXPECT_NE(rigs[2].last_error, "") << "and the fault is named";
    // The frame sets of the budget, with images of the largest size among them.
    EXPECT_LT(most_mb - resident_before_mb, 3000);
    // The log is no way to fill a disk: 40 lines in ten seconds, and some of other kinds.
    std::size_t lines = 0;
    for (const std::string& line : recent_log_lines()) lines += line.find(name) != line.npos;
    EXPECT_GT(lines, 0u);
    EXPECT_LT(lines, 200u);
}

}  // namespace
}  // namespace vantage
