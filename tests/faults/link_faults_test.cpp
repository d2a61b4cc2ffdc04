// What a network does to the frames between a rig and a host, and what becomes of them.
#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include <gtest/gtest.h>

#include "common/receive/stage_receiver.h"
#include "rig_firmware/stream/publisher.h"
#include "tests/faults/impaired_road.h"
#include "tests/support/data_folder.h"
#include "tests/support/eventually.h"
#include "tests/support/keyed_stream.h"
#include "tests/support/wire_frames.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;

/// A stage of 25 pulses a second. A slow computer makes beats longer, and never shorter.
constexpr auto beat_period = 40ms;
/// Two seconds.
constexpr int beats_to_recover = 50;
constexpr int beats_of_trouble = 50;

struct NetworkFault {
    std::string name;
    RoadTrouble trouble;
    std::chrono::milliseconds lasts = beats_of_trouble * beat_period;
    /// Trouble of packets from the rig; empty: the same as of those to it.
    std::optional<RoadTrouble> from_rig = std::nullopt;
    friend void PrintTo(const NetworkFault& fault, std::ostream* out) { *out << fault.name; }
};

/// A stage of two rigs: "far", at the other end of an impaired road, and "near" on this computer.
/// The stage beats once "near" has delivered, so that whatever it lost would be seen, however slow
/// this computer is.
class LinkFaults : public testing::TestWithParam<NetworkFault> {
  protected:
    void SetUp() override {
        if (const std::string reason = ImpairedRoad::reason_against(); !reason.empty())
            GTEST_SKIP() << "SKIPPED: " << reason;
        road_ = std::make_unique<ImpairedRoad>();
        RigConfig::Stream stream = keyed_stream(folder_.path());
        stream.jpeg_quality = 0;
        stream.bind = "tcp://127.0.0.1:*";
        near_ = std::make_unique<Publisher>(stream, "near");
        stream.bind = "tcp://*:5600";
        road_->at_the_rigs([&] { far_ = std::make_unique<Publisher>(stream, "far"); });
        StageConfig stage;
        stage.rate_hz = 25;
        stage.latency_budget_ms = 200;
        stage.key_file = folder_.path() / "host.key";
        stage.rigs.push_back(
            {"far", fmt::format("tcp://{}:5600", ImpairedRoad::rig_address), far_->public_key()});
        stage.rigs.push_back({"near", near_->endpoint(), near_->public_key()});
        host_ = std::make_unique<StageReceiver>(stage);
        ASSERT_TRUE(eventually([&] { return rig(far).connected && rig(near).connected; }));
    }
    void TearDown() override {
        host_.reset();
        far_.reset();
        near_.reset();
    }

    enum Place : std::size_t { far, near };
    RigStatus rig(Place place) const { return host_->status().rigs.at(place); }

    /// Both rigs film a pulse.
    void beat() {
        const auto end = std::chrono::steady_clock::now() + beat_period;
        far_->publish(make_frame(pulse_));
        near_->publish(make_frame(pulse_));
        ++pulse_;
        ++beats_;
        ASSERT_TRUE(eventually([&] { return rig(near).received == beats_; }))
            << "the rig beside has lost a frame";
        while (const auto set = host_->next(0s))
            if (set->slots.at(far).frame) far_seen_ = set->trigger_index;
        std::this_thread::sleep_until(end);
    }
    void beat(int times) {
        for (int i = 0; i < times && !HasFatalFailure(); ++i) beat();
    }

    std::unique_ptr<ImpairedRoad> road_;
    TemporaryFolder folder_;
    std::unique_ptr<Publisher> far_, near_;
    std::unique_ptr<StageReceiver> host_;
    std::uint64_t pulse_ = 1000, beats_ = 0;
    std::uint64_t far_seen_ = 0;  ///< the last pulse with a frame of "far"
};

TEST_P(LinkFaults, ThinOneRigsFramesOutAndEveryOneIsCounted) {
    beat(5);
    ASSERT_TRUE(eventually([&] { return rig(far).received > 0; }));

    const NetworkFault& fault = GetParam();
    road_->impair(fault.trouble, fault.from_rig.value_or(fault.trouble));
    const auto end = std::chrono::steady_clock::now() + fault.lasts;
    // A slow computer sends few packets: until the trouble has met one.
    const auto has_met = [&] {
        const ImpairedRoad::Counts counts = road_->counts();
        return fault.trouble.delay > 0ms ||
               counts.lost + counts.duplicated + counts.corrupted + counts.late > 0;
    };
    while ((std::chrono::steady_clock::now() < end || !has_met()) && !HasFatalFailure()) beat();
    road_->impair({});

    // It is back when a pulse is seen that was filmed after the trouble.
    const std::uint64_t first_after = pulse_;
    int beats = 0;
    while (far_seen_ < first_after && beats < 10 * beats_to_recover && !HasFatalFailure()) {
        beat();
        ++beats;
    }
    EXPECT_GE(far_seen_, first_after);
    EXPECT_LE(beats, beats_to_recover) << "pulses that it took to be back";
    RecordProperty("pulses_to_recover", beats);

    // Nothing is under way any more: every frame is in one counter.
    ASSERT_TRUE(eventually([&] {
        while (host_->next(0s)) {
        }
        const RigStatus status = rig(far);
        return status.rig_counters.published == beats_ &&
               status.link.sent + status.link.send_dropped == status.link.offered &&
               status.received + status.lost == status.link.sent;
    })) <<
        [&] {
            const RigStatus s = rig(far);
            return fmt::format(
                "published {} of {}, offered {}, sent {}, dropped {}, received {}, "
                "lost {}",
                s.rig_counters.published, beats_, s.link.offered, s.link.sent, s.link.send_dropped,
                s.received, s.lost);
        }();
    ASSERT_TRUE(eventually([&] {
        while (host_->next(0s)) {
        }
        const RigStatus status = rig(far);
        return status.in_frame_sets + status.late == status.received;
    }));
    const RigStatus status = rig(far);
    // A rig whose host says nothing for seconds offers frames to nobody.
    const auto may_break = [](const RoadTrouble& trouble) {
        return trouble.is_down || trouble.lose_every > 0 || trouble.corrupt_every > 0 ||
               trouble.lose_over_bytes > 0;
    };
    const bool is_unbroken =
        !may_break(fault.trouble) && !may_break(fault.from_rig.value_or(fault.trouble));
    if (is_unbroken) {
        EXPECT_EQ(status.link.offered, beats_);
    }
    EXPECT_LE(status.link.offered, beats_);
    EXPECT_EQ(status.duplicate, 0u);
    EXPECT_EQ(status.undecodable, 0u) << status.last_error;
    EXPECT_EQ(status.restarts, 0u);
    EXPECT_EQ(status.queue_dropped, 0u);
    // And the rig beside has noticed nothing.
    const RigStatus beside = rig(near);
    EXPECT_EQ(beside.received, beats_);
    EXPECT_EQ(beside.lost, 0u);
    EXPECT_EQ(beside.link.send_dropped, 0u);
}

INSTANTIATE_TEST_SUITE_P(
    Matrix, LinkFaults,
    testing::Values(
        NetworkFault{"Loss1", {.lose_every = 100}}, NetworkFault{"Loss3", {.lose_every = 33}},
        NetworkFault{"Loss7", {.lose_every = 14}}, NetworkFault{"Loss10", {.lose_every = 10}},
        NetworkFault{"Burst40ms", {.is_down = true}, 40ms},
        NetworkFault{"Jitter20ms", {.late_every = 3, .late_by = 20ms}},
        NetworkFault{"Jitter40ms", {.late_every = 2, .late_by = 40ms}},
        NetworkFault{"Reorder", {.late_every = 5, .late_by = 1ms}},
        NetworkFault{"Duplicate", {.duplicate_every = 3}},
        NetworkFault{"Corrupt3", {.corrupt_every = 33}},
        NetworkFault{"Corrupt10", {.corrupt_every = 10}},
        NetworkFault{"RoundTrip1ms", {.delay = 1ms}},
        NetworkFault{"RoundTrip20ms", {.delay = 10ms}},
        NetworkFault{"RoundTrip100ms", {.delay = 50ms}},
        NetworkFault{"Loss1At20ms", {.lose_every = 100, .delay = 10ms}},
        NetworkFault{"Loss3At20ms", {.lose_every = 33, .delay = 10ms}},
        NetworkFault{"Loss7At20ms", {.lose_every = 14, .delay = 10ms}},
        NetworkFault{"Loss10At20ms", {.lose_every = 10, .delay = 10ms}},
        NetworkFault{"Loss1At100ms", {.lose_every = 100, .delay = 50ms}},
        NetworkFault{"Loss3At100ms", {.lose_every = 33, .delay = 50ms}},
        NetworkFault{"Loss7At100ms", {.lose_every = 14, .delay = 50ms}},
        NetworkFault{"Loss10At100ms", {.lose_every = 10, .delay = 50ms}},
        // Radio loses packets in a row, sends others again, and holds up those behind.
        NetworkFault{"WifiBursts",
                     {.lose_every = 60, .lose_run = 12, .late_every = 4, .late_by = 15ms}},
        NetworkFault{"AsymmetricDelay", {.delay = 1ms}, 2s, RoadTrouble{.delay = 60ms}},
        NetworkFault{"AsymmetricLoss", {}, 2s, RoadTrouble{.lose_every = 10}},
        NetworkFault{"AsymmetricLossOfAnswers", {.lose_every = 10}, 2s, RoadTrouble{}},
        // No packet as large as a frame's comes through, and no router says so.
        NetworkFault{"BlackHole", {.lose_over_bytes = 600}},
        NetworkFault{"Down100ms", {.is_down = true}, 100ms},
        NetworkFault{"Down1s", {.is_down = true}, 1s},
        NetworkFault{"Down10s", {.is_down = true}, 10s},
        // By then the kernel's own attempts are six seconds apart.
        NetworkFault{"Down12s", {.is_down = true}, 11900ms}),
    [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace vantage
