// A rig sends frames over SRT through a network that loses, damages, reorders or blocks datagrams.
// Tests that the frames arrive, or go over TCP instead, and that each is counted.
#include <chrono>
#include <memory>
#include <string>
#include <thread>

#include <gmock/gmock.h>
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
using testing::HasSubstr;

/// A rig with the road "srt" at the other end of an impaired road, and a host.
class DatagramFaults : public testing::Test {
  protected:
    void SetUp() override {
        if (const std::string reason = ImpairedRoad::reason_against(); !reason.empty())
            GTEST_SKIP() << "SKIPPED: " << reason;
        road_ = std::make_unique<ImpairedRoad>();
        RigConfig::Stream stream = keyed_stream(folder_.path());
        stream.jpeg_quality = 0;
        stream.bind = "tcp://*:*";
        stream.road = "srt";
        road_->at_the_rigs([&] { rig_ = std::make_unique<Publisher>(stream, "far"); });
    }
    void TearDown() override {
        host_.reset();
        rig_.reset();
    }

    void start_host() {
        StageConfig stage;
        stage.rate_hz = 25;
        stage.key_file = folder_.path() / "host.key";
        const std::string port = rig_->endpoint().substr(rig_->endpoint().rfind(':') + 1);
        stage.rigs.push_back({"far", fmt::format("tcp://{}:{}", ImpairedRoad::rig_address, port),
                              rig_->public_key()});
        host_ = std::make_unique<StageReceiver>(stage);
    }
    bool frames_come_by_datagrams() {
        return eventually(
            [&] { return status().by_datagrams && rig_->status().hosts.at(0).by_datagrams; });
    }
    RigStatus status() const { return host_->status().rigs.at(0); }

    void film(int frames) {
        for (int i = 0; i < frames; ++i) {
            rig_->publish(make_frame(pulse_++, 160, 120));
            while (host_->next(0s)) {
            }
            std::this_thread::sleep_for(40ms);
        }
    }
    /// Films until the condition holds.
    template <class Condition>
    bool film_until(Condition condition) {
        return eventually([&] {
            film(1);
            return condition(status());
        });
    }
    /// Nothing is under way any more, and every frame is in one counter.
    void expect_balanced() {
        EXPECT_TRUE(eventually([&] {
            const RigStatus s = status();
            return s.link.offered == pulse_ - first_pulse &&
                   s.link.sent + s.link.send_dropped + s.link.skipped == s.link.offered &&
                   s.received + s.lost == s.link.sent;
        })) <<
            [&] {
                const RigStatus s = status();
                return fmt::format(
                    "filmed {}, offered {}, sent {}, dropped {}, received {}, lost {}",
                    pulse_ - first_pulse, s.link.offered, s.link.sent, s.link.send_dropped,
                    s.received, s.lost);
            }();
        EXPECT_EQ(status().undecodable, 0u) << status().last_error;
    }

    static constexpr std::uint64_t first_pulse = 1000;
    std::unique_ptr<ImpairedRoad> road_;
    TemporaryFolder folder_;
    std::unique_ptr<Publisher> rig_;
    std::unique_ptr<StageReceiver> host_;
    std::uint64_t pulse_ = first_pulse;
};

TEST_F(DatagramFaults, NoFrameIsLostWherePacketsAre) {
    start_host();
    ASSERT_TRUE(frames_come_by_datagrams());
    for (const unsigned lose_every : {100u, 33u, 14u, 10u}) {
        RoadTrouble trouble;
        trouble.lose_every = lose_every;
        trouble.delay = 10ms;
        trouble.corrupt_every = 50;
        trouble.duplicate_every = 20;
        trouble.late_every = 7;
        trouble.late_by = 3ms;
        road_->impair(trouble);
        film(25);
    }
    EXPECT_GT(road_->counts().lost, 0u);
    road_->impair({});
    expect_balanced();
    EXPECT_EQ(status().lost, 0u);
    EXPECT_TRUE(status().by_datagrams) << status().datagram_trouble;
}

TEST_F(DatagramFaults, FramesComeOverTcpWhereUdpIsBlockedAndByDatagramsOnceItIsOpen) {
    road_->impair({.is_down = true, .only_udp = true});
    start_host();
    ASSERT_TRUE(film_until([](const RigStatus& rig) { return rig.received > 0; }));
    ASSERT_TRUE(film_until([](const RigStatus& rig) { return !rig.datagram_trouble.empty(); }));
    EXPECT_THAT(status().datagram_trouble,
                testing::AllOf(HasSubstr("UDP port"), HasSubstr("firewalls"), HasSubstr("tcp")));
    EXPECT_FALSE(status().by_datagrams);
    const std::uint64_t received = status().received;
    ASSERT_TRUE(film_until([&](const RigStatus& rig) { return rig.received > received + 5; }));

    road_->impair({});
    ASSERT_TRUE(film_until([](const RigStatus& rig) { return rig.by_datagrams; }));
    EXPECT_EQ(status().datagram_trouble, "");
    const std::uint64_t before = status().received;
    ASSERT_TRUE(film_until([&](const RigStatus& rig) { return rig.received > before + 5; }));
    // Offered from the host's first message on.
    const RigStatus rig = status();
    EXPECT_EQ(rig.lost, 0u);
}

TEST_F(DatagramFaults, FramesComeOverTcpWhereDatagramsAreTooLargeForTheWay) {
    start_host();
    ASSERT_TRUE(frames_come_by_datagrams());
    film(5);
    ASSERT_TRUE(film_until([](const RigStatus& rig) { return rig.received > 4; }));
    road_->impair({.lose_over_bytes = 1000, .only_udp = true});
    ASSERT_TRUE(film_until([](const RigStatus& rig) { return !rig.datagram_trouble.empty(); }));
    EXPECT_THAT(status().datagram_trouble, HasSubstr("MTU"));
    const std::uint64_t received = status().received;
    ASSERT_TRUE(film_until([&](const RigStatus& rig) { return rig.received > received + 5; }));
    expect_balanced();
    EXPECT_GT(status().lost, 0u);
}

TEST_F(DatagramFaults, FramesUnderWayAreCountedWhenUdpIsBlockedInTheMiddle) {
    start_host();
    ASSERT_TRUE(frames_come_by_datagrams());
    film(10);
    road_->impair({.is_down = true, .only_udp = true});
    ASSERT_TRUE(film_until([](const RigStatus& rig) { return !rig.datagram_trouble.empty(); }));
    const std::uint64_t received = status().received;
    ASSERT_TRUE(film_until([&](const RigStatus& rig) { return rig.received > received + 5; }));
    expect_balanced();
    road_->impair({});
    ASSERT_TRUE(film_until([](const RigStatus& rig) { return rig.by_datagrams; }));
    film(5);
    expect_balanced();
}

}  // namespace
}  // namespace vantage
