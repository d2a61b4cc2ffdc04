#include <atomic>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <thread>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "common/base/time/pulse_grid.h"
#include "common/config/calibration_file.h"
#include "rig_firmware/capture/rig_calibration.h"
#include "rig_firmware/clock/clock_pair.h"
#include "rig_firmware/trigger/edge_watcher.h"
#include "rig_firmware/trigger/pulse_line.h"
#include "tests/hil/devices/rig_process.h"
#include "tests/support/data_folder.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

/// Pulses every two seconds, and a camera that runs by itself at one frame per second and stamps it
/// as it is taken: whatever its phase, one picture of two lies within a quarter of a period of its
/// pulse, and the other of none. The delay of its stamps is more than that quarter, so that a
/// picture never comes before its pulse, as it cannot with a sensor on a wire.
constexpr double rate_hz = 0.5;
constexpr std::chrono::nanoseconds period = 2s;

/// A rig with one webcam of vivid (video14, both sides in one picture) and a line of gpio-sim.
class TriggerRole : public testing::Test {
  protected:
    void SetUp() override {
        calibration_ = (folder_.path() / "rig.yaml").string();
        save_calibration(calibration_, ideal_rig(RigConfig{}, {160, 180}), {});
    }

    std::string parts(const std::string& role, const std::string& line) const {
        return "calibration = \"" + calibration_ +
               "\"\n[source]\nkind = \"v4l2\"\nrate_hz = 0.5\nwidth_px = 160\nheight_px = 180\n"
               "left_device = \"/dev/video14\"\nside_by_side = true\npixel_format = "
               "\"YUYV\"\nbuffers = \"copy\"\n"
               "[source.controls]\n\"Timestamp Source\" = 1\n"
               "[match]\npreset = \"fast\"\ndisparities = 16\nsteady = false\n"
               "[trigger]\nrole = \"" +
               role + "\"\nchip = \"vantage-test\"\nline = \"" + line +
               "\"\nexposure_us = 100000\ntimestamp_delay_us = 700000\n"
               "late_limit_us = 400000\n";
    }
    static RigConfig::Trigger line(const std::string& name) {
        RigConfig::Trigger trigger;
        trigger.chip = "vantage-test";
        trigger.line = name;
        return trigger;
    }

    /// Takes frames until so many more with a pulse have come. One without goes by the pulse before
    /// it, and a host that has that pulse's frame leaves it out.
    void take_frames(RigProcess& rig, std::size_t more) {
        const std::size_t wanted = synchronized_.size() + more;
        constexpr int most_frames = 60;
        for (int i = 0; i < most_frames && synchronized_.size() < wanted; ++i) {
            const auto frame = rig.next_frame();
            if (!frame->synchronized || frame->session == ended_session_) continue;
            session_ = frame->session;
            EXPECT_TRUE(synchronized_.insert(frame->trigger_index).second)
                << "two frames of pulse " << frame->trigger_index;
            const auto off = frame->exposure - grid_.time_of(frame->trigger_index);
            EXPECT_LT(std::abs((off - 50ms).count()), (period / 4).count())
                << "the middle of an exposure of 100 ms";
        }
        EXPECT_GE(synchronized_.size(), wanted) << rig.log();
    }

    /// Another rig's pulses: those that `sends` says.
    std::jthread lead(std::function<bool(std::uint64_t)> sends) const {
        std::shared_ptr<PulseLine> wire = open_pulse_line(line("TRIGGER"));
        return std::jthread(
            [this, wire = std::move(wire), sends = std::move(sends)](const std::stop_token& stop) {
                while (!stop.stop_requested()) {
                    const std::uint64_t index = grid_.index_at_or_before(TaiClock::now()) + 1;
                    std::this_thread::sleep_for(grid_.time_of(index) - TaiClock::now());
                    if (!sends(index)) continue;
                    wire->set(true);
                    std::this_thread::sleep_for(100ms);
                    wire->set(false);
                }
            });
    }

    /// Whether it says so within two minutes, beyond so many bytes of its log.
    static bool says(const RigProcess& rig, const std::string& sentence, std::size_t beyond) {
        for (int i = 0; i < 1200; ++i) {
            if (rig.log().find(sentence, beyond) != std::string::npos) return true;
            std::this_thread::sleep_for(100ms);
        }
        return false;
    }

    TemporaryFolder folder_;
    std::string calibration_;
    const PulseGrid grid_{rate_hz};
    std::set<std::uint64_t> synchronized_;
    std::uint64_t session_ = 0;        ///< of the last frame
    std::uint64_t ended_session_ = 0;  ///< what still lies there of it is left out
};

TEST_F(TriggerRole, FollowGivesFramesTheIndexOfThePulseThatTheKernelSaw) {
    RigProcess rig(parts("follow", "TRIGGER_SEEN"));
    std::set<std::uint64_t> sent;
    std::jthread leader =
        lead([&](std::uint64_t index) { return index % 4 != 0 && sent.insert(index).second; });
    take_frames(rig, 6);
    leader.request_stop();
    leader.join();
    for (const std::uint64_t index : synchronized_)
        EXPECT_TRUE(sent.contains(index)) << index << " was not sent";
    const nlohmann::json summary = nlohmann::json::parse(rig.stop());
    std::printf("hil: follow %s\n", summary["sync"].dump().c_str());
    EXPECT_GE(summary["sync"]["pulses"], 6) << summary;
    EXPECT_LE(summary["sync"]["pulses"], sent.size()) << summary;
    EXPECT_GE(summary["sync"]["skipped"], 1)
        << "pulses that were not sent were not seen: " << summary;
    EXPECT_GE(summary["sync"]["unsynchronized"], 4) << summary;
    EXPECT_THAT(rig.log(), HasSubstr("every picture is copied to the GPU: as configured"));
    EXPECT_GE(summary["source"]["copied_pictures"], 12) << summary;
}

TEST_F(TriggerRole, FollowNamesAWireThatIsPulledAndIsInStepOnceItIsBack) {
    RigProcess rig(parts("follow", "TRIGGER_SEEN"));
    std::atomic<bool> is_pulled = false;
    const std::jthread leader = lead([&](std::uint64_t) { return !is_pulled; });
    take_frames(rig, 2);
    const std::uint64_t session = session_;
    std::size_t said = rig.log().size();
    is_pulled = true;
    EXPECT_TRUE(says(rig, "no pulse seen on ", said)) << rig.log();
    const TaiTime named = TaiClock::now();
    // This camera runs by itself. One that waits for its pulse sends nothing now.
    for (int others = 0; others < 3;) {
        const auto frame = rig.next_frame();
        if (frame->exposure < named) continue;
        EXPECT_FALSE(frame->synchronized) << frame->trigger_index;
        ++others;
    }
    said = rig.log().size();
    is_pulled = false;
    EXPECT_TRUE(says(rig, "pulses are seen again on ", said)) << rig.log();
    take_frames(rig, 3);
    EXPECT_EQ(session_, session) << "its daemon went on";
    const nlohmann::json summary = nlohmann::json::parse(rig.stop());
    std::printf("hil: pulled %s\n", summary["sync"].dump().c_str());
    EXPECT_GE(summary["sync"]["skipped"], 1) << "pulses that were not seen: " << summary;
    EXPECT_GE(summary["sync"]["unsynchronized"], 3) << summary;
}

TEST_F(TriggerRole, LeadGivesFramesTheIndexOfThePulseThatItSent) {
    EdgeWatcher watcher(line("TRIGGER_SEEN"));
    std::set<std::uint64_t> seen;
    std::jthread reader([&](const std::stop_token& stop) {
        while (!stop.stop_requested()) {
            const auto edge = watcher.next(100ms);
            if (edge && edge->leading)
                seen.insert(grid_.nearest_index(ClockPair::now().to_tai(edge->time)));
        }
    });
    RigProcess rig(parts("lead", "TRIGGER"));
    take_frames(rig, 3);
    const nlohmann::json summary = nlohmann::json::parse(rig.stop());
    reader.request_stop();
    reader.join();
    std::printf("hil: lead %s\n", summary["sync"].dump().c_str());
    for (const std::uint64_t index : synchronized_)
        EXPECT_TRUE(seen.contains(index)) << "no edge of pulse " << index;
    EXPECT_GE(summary["sync"]["pulses"], 3) << summary;
    EXPECT_GE(summary["sync"]["unsynchronized"], 2) << summary;

    // Started again in the same take: it joins at the running pulse, not at the first.
    const std::uint64_t last = *synchronized_.rbegin();
    const std::uint64_t running = grid_.index_at_or_before(TaiClock::now());
    ended_session_ = session_;
    rig.start();
    take_frames(rig, 1);
    EXPECT_GT(*synchronized_.rbegin(), last);
    EXPECT_GE(*synchronized_.rbegin(), running);
    const nlohmann::json again = nlohmann::json::parse(rig.stop());
    std::printf("hil: lead again %s\n", again.dump().c_str());
    EXPECT_EQ(again["sync"]["first_pulse"], summary["sync"]["first_pulse"]) << again;
    EXPECT_LE(again["sync"]["pulses"].get<std::uint64_t>(),
              grid_.index_at_or_before(TaiClock::now()) - running)
        << "pulses of before were made up for";
}

}  // namespace
}  // namespace vantage
