#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <zmq.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/receive/stage_receiver.h"
#include "common/wire/curve_keys.h"
#include "common/wire/link_message.h"
#include "rig_firmware/stream/publisher.h"
#include "tests/support/data_folder.h"
#include "tests/support/eventually.h"
#include "tests/support/thrown_sentence.h"
#include "tests/support/wire_frames.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

/// Far beyond what any of this takes; a test that waits so long has failed.
constexpr auto patience = 60s;

class LinkTest : public testing::Test {
  protected:
    RigConfig::Stream open_stream() const {
        RigConfig::Stream stream;
        stream.bind = "tcp://127.0.0.1:*";
        stream.jpeg_quality = 0;
        return stream;
    }

    RigConfig::Stream secured_stream(const std::vector<CurveKeys>& hosts) {
        RigConfig::Stream stream = open_stream();
        stream.key_file = folder_.path() / "rig.key";
        stream.authorized_hosts = folder_.path() / "authorized_hosts";
        if (!std::filesystem::exists(stream.key_file))
            write_key_file(stream.key_file, generate_curve_keys());
        authorize(hosts);
        return stream;
    }

    void authorize(const std::vector<CurveKeys>& hosts) const {
        std::ofstream list(folder_.path() / "authorized_hosts");
        list << "# hosts of the test\n";
        for (const CurveKeys& host : hosts) list << host.public_key << " a host\n";
    }

    std::filesystem::path key_file_of(const CurveKeys& keys) {
        const std::filesystem::path path = folder_.path() / fmt::format("host-{}.key", next_key_++);
        write_key_file(path, keys);
        return path;
    }

    static StageConfig stage_of(const Publisher& rig, const std::filesystem::path& host_key = {}) {
        StageConfig stage;
        stage.rigs.push_back({"rig-a", rig.endpoint(), rig.public_key()});
        stage.key_file = host_key;
        stage.latency_budget_ms = 50;
        return stage;
    }

    static bool connected(const StageReceiver& host, std::size_t rig = 0) {
        return host.status().rigs.at(rig).connected;
    }

    TemporaryFolder folder_;
    int next_key_ = 0;
};

TEST_F(LinkTest, AReportIsSentToTheHostThatRequestsIt) {
    const CurveKeys host_keys = generate_curve_keys();
    Publisher rig(secured_stream({host_keys}), "rig-a");
    int asked = 0;
    rig.serve_reports([&](const std::atomic<bool>&) { return fmt::format("report {}", ++asked); });
    StageReceiver silent(stage_of(rig, key_file_of(host_keys)), StageReceiver::Purpose::observe);
    StageReceiver host(stage_of(rig, key_file_of(host_keys)), StageReceiver::Purpose::observe);
    ASSERT_TRUE(eventually([&] { return connected(host) && connected(silent); }));
    EXPECT_EQ(host.report_of(0), nullptr);
    host.ask_for_reports();
    ASSERT_TRUE(eventually([&] { return host.report_of(0) != nullptr; }));
    EXPECT_EQ(*host.report_of(0), "report 1");
    host.ask_for_reports();
    ASSERT_TRUE(eventually([&] { return *host.report_of(0) == "report 2"; }));
    EXPECT_EQ(silent.report_of(0), nullptr);
    EXPECT_EQ(silent.status().rigs[0].undecodable, 0u);
}

TEST_F(LinkTest, FramesCrossTheSecuredLinkBitExact) {
    const CurveKeys host_keys = generate_curve_keys();
    Publisher rig(secured_stream({host_keys}), "rig-a");
    StageReceiver host(stage_of(rig, key_file_of(host_keys)));
    ASSERT_TRUE(eventually([&] { return connected(host); }));

    constexpr std::uint64_t frames = 20;
    for (std::uint64_t k = 1000; k < 1000 + frames; ++k) {
        const RigFrame sent = make_frame(k);
        rig.publish(sent);
        const std::optional<FrameSet> set = host.next(patience);
        ASSERT_TRUE(set);
        ASSERT_EQ(set->present(), 1);
        const RigFrame& got = *set->slots[0].frame;
        EXPECT_EQ(got.trigger_index, k);
        EXPECT_EQ(got.session, rig.session());
        EXPECT_TRUE(same_pixels(got.colour, sent.colour));
        EXPECT_TRUE(same_pixels(got.disparity, sent.disparity));
        EXPECT_TRUE(got.world_from_camera.isApprox(sent.world_from_camera, 0));
    }
    const RigStatus status = host.status().rigs.at(0);
    EXPECT_EQ(status.received, frames);
    EXPECT_EQ(status.in_frame_sets, frames);
    EXPECT_EQ(status.lost, 0u);
    EXPECT_EQ(status.undecodable, 0u);
}

TEST_F(LinkTest, FramesOfARigThatIsNotDecodedStayPacked) {
    Publisher rig(open_stream(), "rig-a");
    StageReceiver host(stage_of(rig));
    ASSERT_TRUE(eventually([&] { return connected(host); }));
    const auto next = [&](std::uint64_t k) {
        const auto sent = rig.publish(make_frame(k));
        const std::optional<FrameSet> set = host.next(patience);
        EXPECT_TRUE(set && set->present() == 1);
        EXPECT_EQ(set->slots[0].frame->packed->colour, sent->colour);
        EXPECT_EQ(set->slots[0].frame->trigger_index, k);
        return *set->slots[0].frame;
    };
    EXPECT_TRUE(next(1000).has_pictures());
    host.set_decoded("rig-a", false);
    EXPECT_FALSE(next(1001).has_pictures());
    EXPECT_EQ(next(1002).geometry.width_px, 61) << "all but the pictures is known";
    host.set_decoded("rig-a", true);
    EXPECT_TRUE(same_pixels(next(1003).colour, make_frame(1003).colour));
    EXPECT_EQ(host.status().rigs[0].in_frame_sets, 4u);
    EXPECT_THROW(host.set_decoded("rig-b", true), Error);
}

TEST_F(LinkTest, AnUnknownHostGetsInstructionsAndIsAdmittedOnceListed) {
    const CurveKeys host_keys = generate_curve_keys();
    Publisher rig(secured_stream({}), "rig-a");
    StageReceiver host(stage_of(rig, key_file_of(host_keys)));
    ASSERT_TRUE(eventually([&] { return !host.status().rigs[0].refused.empty(); }));
    EXPECT_THAT(host.status().rigs[0].refused, HasSubstr(host_keys.public_key));
    EXPECT_THAT(host.status().rigs[0].refused, HasSubstr("authorized_hosts"));
    EXPECT_FALSE(connected(host));
    EXPECT_TRUE(rig.status().hosts.empty());

    authorize({host_keys});
    ASSERT_TRUE(eventually([&] { return connected(host); }));
    EXPECT_EQ(host.status().rigs[0].refused, "");
}

TEST_F(LinkTest, AWrongRigKeyIsRefusedWithASentence) {
    const CurveKeys host_keys = generate_curve_keys();
    Publisher rig(secured_stream({host_keys}), "rig-a");
    StageConfig stage = stage_of(rig, key_file_of(host_keys));
    stage.rigs[0].public_key = generate_curve_keys().public_key;
    StageReceiver host(stage);
    ASSERT_TRUE(eventually([&] { return !host.status().rigs[0].refused.empty(); }));
    EXPECT_THAT(host.status().rigs[0].refused, HasSubstr("public_key"));
}

TEST_F(LinkTest, AHostWithoutKeysIsRefusedByARigWithKeys) {
    Publisher rig(secured_stream({}), "rig-a");
    StageConfig stage = stage_of(rig);
    stage.rigs[0].public_key.clear();
    StageReceiver host(stage);
    ASSERT_TRUE(eventually([&] { return !host.status().rigs[0].refused.empty(); }));
    EXPECT_THAT(host.status().rigs[0].refused, HasSubstr("public_key"));
}

TEST_F(LinkTest, ARigOfAnotherNameIsRefused) {
    Publisher rig(open_stream(), "rig-b");
    StageReceiver host(stage_of(rig));
    ASSERT_TRUE(eventually([&] { return !host.status().rigs[0].refused.empty(); }));
    EXPECT_THAT(host.status().rigs[0].refused, HasSubstr("rig-b"));
}

TEST_F(LinkTest, ARestartedRigIsFollowed) {
    RigConfig::Stream stream = open_stream();
    auto rig = std::make_unique<Publisher>(stream, "rig-a");
    stream.bind = rig->endpoint();
    StageReceiver host(stage_of(*rig));
    ASSERT_TRUE(eventually([&] { return connected(host); }));
    rig->publish(make_frame(5000));
    ASSERT_TRUE(host.next(patience));
    const std::uint64_t first_session = rig->session();

    rig.reset();
    ASSERT_TRUE(eventually([&] { return !connected(host); }));
    rig = std::make_unique<Publisher>(stream, "rig-a");
    ASSERT_TRUE(eventually([&] { return connected(host); }));
    rig->publish(make_frame(7));
    const std::optional<FrameSet> set = host.next(patience);
    ASSERT_TRUE(set);
    EXPECT_EQ(set->trigger_index, 7u);
    EXPECT_NE(set->slots[0].frame->session, first_session);
    EXPECT_EQ(host.status().rigs[0].in_frame_sets, 2u);
}

TEST_F(LinkTest, TwoRigsMeetByTriggerIndex) {
    Publisher a(open_stream(), "rig-a");
    Publisher b(open_stream(), "rig-b");
    StageConfig stage = stage_of(a);
    stage.rigs.push_back({"rig-b", b.endpoint(), ""});
    stage.latency_budget_ms = 30000;
    StageReceiver host(stage);
    ASSERT_TRUE(eventually([&] { return connected(host, 0) && connected(host, 1); }));
    // The first frame of a rig puts it in play; nobody waits for it before.
    a.publish(make_frame(1));
    ASSERT_TRUE(host.next(patience));
    b.publish(make_frame(1));
    ASSERT_TRUE(eventually([&] { return host.status().rigs[1].late == 1; }));
    for (std::uint64_t k = 2; k < 6; ++k) {
        a.publish(make_frame(k));
        b.publish(make_frame(k));
        const std::optional<FrameSet> set = host.next(patience);
        ASSERT_TRUE(set);
        EXPECT_EQ(set->trigger_index, k);
        EXPECT_EQ(set->present(), 2);
    }
    EXPECT_EQ(host.status().complete_frame_sets, 4u);
}

TEST_F(LinkTest, DroppedFrameSetsAreCountedWithTheirFrames) {
    Publisher rig(open_stream(), "rig-a");
    StageReceiver receiver(stage_of(rig));
    ASSERT_TRUE(eventually([&] { return connected(receiver, 0); }));
    for (std::uint64_t k = 1; k <= 6; ++k) {
        rig.publish(make_frame(k));
        ASSERT_TRUE(eventually([&] { return receiver.status().sets == k; }));
    }
    std::uint64_t taken = 0;
    while (receiver.next(100ms)) ++taken;
    const ReceiverStatus status = receiver.status();
    EXPECT_GT(status.frame_sets_dropped, 0u);
    EXPECT_EQ(status.rigs[0].in_dropped_frame_sets, status.frame_sets_dropped);
    EXPECT_EQ(status.rigs[0].in_frame_sets, taken + status.rigs[0].in_dropped_frame_sets);
}

TEST_F(LinkTest, ARigSkipsPulsesAsRequested) {
    Publisher rig(open_stream(), "rig-a");
    StageReceiver host(stage_of(rig));
    ASSERT_TRUE(eventually([&] { return connected(host); }));
    host.ask("rig-a", true, 3);
    // The request is in force once a frame that it leaves out is counted as skipped.
    std::uint64_t k = 1;
    ASSERT_TRUE(eventually([&] {
        rig.publish(make_frame(k));
        k += 3;
        return rig.status().hosts.at(0).counters.skipped > 0;
    }));
    while (host.next(100ms)) {
    }
    rig.publish(make_frame(3 * k));
    const std::optional<FrameSet> set = host.next(patience);
    ASSERT_TRUE(set);
    EXPECT_EQ(set->trigger_index, 3 * k);
    EXPECT_THROW(host.ask("rig-z", true, 1), Error);
    EXPECT_THROW(host.ask("rig-a", true, 0), Error);
}

/// A host of which the test moves every word.
class ScriptedHost {
  public:
    explicit ScriptedHost(const std::string& endpoint)
        : socket_(context_, zmq::socket_type::dealer) {
        socket_.set(zmq::sockopt::linger, 0);
        socket_.set(zmq::sockopt::rcvtimeo,
                    static_cast<int>(std::chrono::milliseconds(patience).count()));
        socket_.connect(endpoint);
    }

    void say(const HostMessage& message) { say_bytes(encode(message)); }
    void say_bytes(const std::vector<std::byte>& bytes) {
        socket_.send(zmq::buffer(bytes), zmq::send_flags::none);
    }

    /// The next message; the number of its parts goes to `parts`.
    RigMessage hear(std::size_t& parts) {
        zmq::message_t first;
        if (!socket_.recv(first)) throw Error("nothing came");
        zmq::message_t part;
        bool more = first.more();
        for (parts = 1; more; ++parts) {
            if (!socket_.recv(part)) throw Error("a part is missing");
            more = part.more();
        }
        return decode_rig_message({first.data<std::byte>(), first.size()});
    }

  private:
    zmq::context_t context_;
    zmq::socket_t socket_;
};

TEST_F(LinkTest, AStalledHostMakesTheRigDropTheOldestAndCountThem) {
    RigConfig::Stream stream = open_stream();
    stream.queue_frames = 4;
    Publisher rig(stream, "rig-a");
    ScriptedHost host(rig.endpoint());
    std::size_t parts = 0;
    HostMessage request;
    request.host_id = 9;
    request.credit_window = 3;
    host.say(request);
    const RigMessage welcome = host.hear(parts);
    EXPECT_EQ(parts, 1u);
    EXPECT_EQ(welcome.counters.sent, 0u);
    request.link = welcome.link;
    host.say(request);

    // Nothing is granted from here on: three are sent, four wait, the rest is dropped.
    rig.publish(make_frame(0));
    ASSERT_TRUE(eventually([&] {
        host.say(request);
        return rig.status().hosts.at(0).counters.sent == 1;
    }));
    for (std::uint64_t k = 1; k < 3; ++k) rig.publish(make_frame(k));
    ASSERT_TRUE(eventually([&] {
        host.say(request);
        return rig.status().hosts.at(0).counters.sent == 3;
    }));
    for (std::uint64_t k = 3; k < 20; ++k) rig.publish(make_frame(k));
    const HostLinks::HostStatus stalled = rig.status().hosts.at(0);
    EXPECT_EQ(stalled.counters.offered, 20u);
    EXPECT_EQ(stalled.counters.sent, 3u);
    EXPECT_EQ(stalled.queued, 4u);
    EXPECT_EQ(stalled.counters.send_dropped, 13u);
    EXPECT_EQ(rig.status().counters.send_dropped, 13u);

    request.handled = 3;
    request.credit_window = 16;
    host.say(request);
    ASSERT_TRUE(eventually([&] {
        host.say(request);
        return rig.status().hosts.at(0).queued == 0;
    }));
    std::uint64_t deliveries = 0;
    while (deliveries < 7) {
        const RigMessage message = host.hear(parts);
        if (parts == 1) continue;
        ++deliveries;
        EXPECT_EQ(parts, 4u);
        EXPECT_EQ(message.counters.sent, deliveries);
    }
}

TEST_F(LinkTest, GarbageToTheRigIsAnsweredWithASentence) {
    Publisher rig(open_stream(), "rig-a");
    ScriptedHost host(rig.endpoint());
    host.say_bytes({std::byte{0xff}, std::byte{0x07}});
    std::size_t parts = 0;
    EXPECT_THAT(host.hear(parts).refusal, HasSubstr("truncated or damaged"));
    EXPECT_TRUE(rig.status().hosts.empty());
}

TEST_F(LinkTest, WithoutKeysNothingBeyondThisComputerIsServedOrReached) {
    RigConfig::Stream stream;
    stream.bind = "tcp://0.0.0.0:5600";
    EXPECT_THAT(thrown_sentence([&] { const Publisher rig(stream, "rig-a"); }),
                HasSubstr("stream.key_file"));
    StageConfig stage;
    stage.rigs.push_back({"rig-a", "tcp://192.0.2.7:5600", ""});
    EXPECT_THAT(thrown_sentence([&] { const StageReceiver host(stage); }), HasSubstr("public_key"));
}

TEST_F(LinkTest, APortInUseIsNamed) {
    const Publisher first(open_stream(), "rig-a");
    RigConfig::Stream stream = open_stream();
    stream.bind = first.endpoint();
    const std::string sentence = thrown_sentence([&] { const Publisher rig(stream, "rig-b"); });
    EXPECT_THAT(sentence, HasSubstr("in use"));
    EXPECT_THAT(sentence, HasSubstr(stream.bind.substr(stream.bind.rfind(':') + 1)));
}

TEST_F(LinkTest, TheFirstPulseIsAnnouncedOnceEveryRigIsReady) {
    Publisher a(open_stream(), "rig-a"), b(open_stream(), "rig-b");
    StageConfig stage = stage_of(a);
    stage.rigs.push_back({"rig-b", b.endpoint(), {}});
    RigSync armed;
    armed.role = RigSync::Role::lead;
    armed.ready = true;
    a.report(armed);
    StageReceiver host(stage);
    ASSERT_TRUE(eventually([&] { return host.status().rigs[0].sync == armed; }));
    EXPECT_EQ(a.announced_pulse(), 0u);
    b.report(armed);
    ASSERT_TRUE(eventually([&] { return a.announced_pulse() != 0 && b.announced_pulse() != 0; }));
    EXPECT_EQ(a.announced_pulse(), b.announced_pulse());
}

TEST_F(LinkTest, ARestartedRigJoinsTheRunningTake) {
    Publisher running(open_stream(), "rig-a");
    RigSync started;
    started.role = RigSync::Role::lead;
    started.ready = true;
    started.first_pulse = 4711;
    running.report(started);
    StageConfig stage = stage_of(running);
    Publisher again(open_stream(), "rig-b");
    stage.rigs.push_back({"rig-b", again.endpoint(), {}});
    StageReceiver host(stage);
    EXPECT_TRUE(eventually([&] { return again.announced_pulse() == 4711; }));
}

TEST_F(LinkTest, AnObservingHostStartsNoTake) {
    Publisher rig(open_stream(), "rig-a");
    RigSync armed;
    armed.role = RigSync::Role::lead;
    armed.ready = true;
    rig.report(armed);
    StageReceiver onlooker(stage_of(rig), StageReceiver::Purpose::observe);
    ASSERT_TRUE(eventually([&] { return onlooker.status().rigs[0].sync == armed; }));
    std::this_thread::sleep_for(2 * heartbeat_period);
    EXPECT_EQ(rig.announced_pulse(), 0u);
}

TEST_F(LinkTest, ACalibratingHostGetsRawPairsWhileAnotherOneFilms) {
    Publisher rig(open_stream(), "rig-a");
    StageReceiver films(stage_of(rig));
    StageReceiver calibrates(stage_of(rig), StageReceiver::Purpose::calibrate);
    ASSERT_TRUE(eventually([&] { return connected(films) && connected(calibrates); }));
    ASSERT_TRUE(eventually([&] { return rig.wants_raw_pair(7); }));
    RigFrame view = make_frame(7);
    RigFrame pair = make_frame(7);
    pair.content = RigFrame::Content::raw_pair;
    pair.right = make_frame(8).colour;
    pair.disparity = DisparityImage();
    rig.publish(view);
    rig.publish(pair);
    const std::optional<FrameSet> filmed = films.next(patience);
    const std::optional<FrameSet> raw = calibrates.next(patience);
    ASSERT_TRUE(filmed && filmed->slots[0].frame && raw && raw->slots[0].frame);
    EXPECT_EQ(filmed->slots[0].frame->content, RigFrame::Content::view);
    EXPECT_EQ(raw->slots[0].frame->content, RigFrame::Content::raw_pair);
    EXPECT_TRUE(same_pixels(raw->slots[0].frame->right, pair.right));
    EXPECT_EQ(rig.status().counters.published, 1u);
}

TEST_F(LinkTest, FramesCarryTheNewestRightImage) {
    RigConfig::Stream stream = open_stream();
    stream.jpeg_quality = 85;
    Publisher rig(stream, "rig-a");
    StageReceiver host(stage_of(rig));
    ASSERT_TRUE(eventually([&] { return connected(host); }));
    const auto got = [&](std::uint64_t pulse, bool with_right) {
        RigFrame frame = make_frame(pulse);
        if (with_right) frame.right = make_frame(pulse + 1).colour;
        rig.publish(frame);
        const std::optional<FrameSet> set = host.next(patience);
        return set && set->slots[0].frame ? set->slots[0].frame->right_jpeg : nullptr;
    };
    EXPECT_FALSE(got(7, false));
    const SharedBytes first = got(8, true);
    ASSERT_TRUE(first);
    EXPECT_EQ(got(9, false), first);
    const SharedBytes second = got(10, true);
    ASSERT_TRUE(second);
    EXPECT_NE(*second, *first);
    EXPECT_EQ(got(11, false), second);
}

TEST_F(LinkTest, ReportsUndisciplinedClocks) {
    RigStatus rig;
    EXPECT_THAT(clock_text(rig), HasSubstr("clocks not disciplined: skew unknown"));
    rig.sync.ptp_state = "LISTENING";
    EXPECT_THAT(clock_text(rig), HasSubstr("ptp4l is LISTENING"));
    rig.sync.disciplined = true;
    rig.sync.ptp_state = "SLAVE";
    rig.sync.ptp_offset_ns = -151;
    rig.sync.ptp_path_delay_ns = 1000;
    EXPECT_EQ(clock_text(rig), "PTP SLAVE, offset -151 ns, path delay 1000 ns");
    rig.sync.disciplined = false;
    EXPECT_THAT(clock_text(rig), HasSubstr("clocks not disciplined: skew unknown"));
    EXPECT_THAT(clock_text(rig), HasSubstr("phc2sys"));
}

TEST_F(LinkTest, WarnsOfDifferentTaiOffsets) {
    RigStatus rig;
    rig.sync.tai_offset_s = rig.own_tai_offset_s = 37;
    EXPECT_EQ(tai_warning(rig), "");
    rig.own_tai_offset_s = 0;
    EXPECT_THAT(tai_warning(rig), HasSubstr("37 s"));
    EXPECT_THAT(clock_text(rig), HasSubstr(tai_warning(rig)));
}

class ReloadTest : public LinkTest {
  protected:
    static void follow(StageReceiver& host, const StageConfig& stage) {
        host.follow(host.prepare(stage));
    }
    /// Publishes until the host has a frame set with the frame; the pulses go on from `pulse_`.
    FrameSet frame_set_with(StageReceiver& host, const std::vector<Publisher*>& rigs) {
        FrameSet set;
        EXPECT_TRUE(eventually([&] {
            ++pulse_;
            for (std::size_t i = 0; i < rigs.size(); ++i) {
                RigFrame frame = make_frame(pulse_);
                frame.rig = names_[i];
                rigs[i]->publish(frame);
            }
            const std::optional<FrameSet> next = host.next(1s);
            if (next) set = *next;
            return next && next->present() == static_cast<int>(rigs.size());
        }));
        return set;
    }
    std::vector<std::string> names_;
    std::uint64_t pulse_ = 1000;
};

TEST_F(ReloadTest, ARigJoinsAndARigLeavesWhileAnotherIsUndisturbed) {
    Publisher stays(open_stream(), "stays"), leaves(open_stream(), "leaves"),
        joins(open_stream(), "joins");
    StageConfig stage;
    stage.latency_budget_ms = 1000;
    stage.rigs = {{"leaves", leaves.endpoint(), ""}, {"stays", stays.endpoint(), ""}};
    std::vector<std::size_t> numbers;
    StageReceiver host(stage, StageReceiver::Purpose::film,
                       [&](const ArrivedFrame& frame) { numbers.push_back(frame.rig); });
    ASSERT_TRUE(eventually([&] { return connected(host, 0) && connected(host, 1); }));
    names_ = {"leaves", "stays"};
    (void)frame_set_with(host, {&leaves, &stays});
    const std::vector<RigStatus> before = host.status().rigs;

    StageConfig changed = stage;
    changed.rigs = {{"stays", stays.endpoint(), ""}, {"joins", joins.endpoint(), ""}};
    StageReceiver::Update update = host.prepare(changed);
    EXPECT_THAT(update.names(), testing::ElementsAre("leaves", "stays", "joins"));
    host.follow(std::move(update));
    names_ = {"stays", "joins"};
    const FrameSet set = frame_set_with(host, {&stays, &joins});
    ASSERT_EQ(set.slots.size(), 2u);
    EXPECT_EQ(set.slots[0].rig, "stays") << "in the order of the stage";
    EXPECT_EQ(set.slots[1].rig, "joins");

    const std::vector<RigStatus> rigs = host.status().rigs;
    ASSERT_EQ(rigs.size(), 3u);
    EXPECT_EQ(rigs[0].rig, "stays");
    EXPECT_EQ(rigs[0].outages, 0u);
    EXPECT_EQ(rigs[0].lost, 0u);
    EXPECT_EQ(rigs[0].in_frame_sets - before[1].in_frame_sets,
              rigs[0].received - before[1].received);
    EXPECT_EQ(rigs[0].received, pulse_ - 1000) << "every frame, before and after";
    EXPECT_EQ(rigs[1].rig, "joins");
    EXPECT_EQ(rigs[2].rig, "leaves");
    EXPECT_TRUE(rigs[2].is_removed);
    EXPECT_FALSE(rigs[2].connected);
    EXPECT_EQ(rigs[2].outages, 0u) << "removed is not gone";
    EXPECT_EQ(trouble_of(rigs[2]), "removed from the stage");
    EXPECT_EQ(rigs[2].in_frame_sets, before[0].in_frame_sets);
    ASSERT_TRUE(eventually([&] { return !leaves.status().hosts.at(0).attached; }));

    // It comes back with its number and its counts.
    follow(host, stage);
    names_ = {"leaves", "stays"};
    (void)frame_set_with(host, {&leaves, &stays});
    const RigStatus back = host.status().rigs[0];
    EXPECT_FALSE(back.is_removed);
    EXPECT_EQ(back.rig, "leaves");
    EXPECT_EQ(back.restarts, 0u);
    EXPECT_EQ(back.outages, 0u);
    EXPECT_GT(back.in_frame_sets, before[0].in_frame_sets);
    host.ask("joins", false, 1);
    EXPECT_THROW(host.ask("nobody", false, 1), Error);
}

TEST_F(ReloadTest, ARigIsFollowedToAnotherEndpoint) {
    auto rig = std::make_unique<Publisher>(open_stream(), "rig-a");
    StageReceiver host(stage_of(*rig));
    names_ = {"rig-a"};
    (void)frame_set_with(host, {rig.get()});
    const std::uint64_t before = host.status().rigs[0].received;
    rig = std::make_unique<Publisher>(open_stream(), "rig-a");
    follow(host, stage_of(*rig));
    (void)frame_set_with(host, {rig.get()});
    const RigStatus status = host.status().rigs[0];
    EXPECT_EQ(status.endpoint, rig->endpoint());
    EXPECT_EQ(status.restarts, 1u);
    EXPECT_GT(status.received, before) << "the counts go on";
}

TEST_F(ReloadTest, AnInvalidStageChangesNothing) {
    Publisher rig(open_stream(), "rig-a");
    StageReceiver host(stage_of(rig));
    names_ = {"rig-a"};
    (void)frame_set_with(host, {&rig});
    StageConfig bad = stage_of(rig);
    bad.rigs.push_back({"rig-b", "tcp://192.0.2.1:5600", ""});
    EXPECT_THAT(thrown_sentence([&] { (void)host.prepare(bad); }), HasSubstr("needs keys"));
    (void)frame_set_with(host, {&rig});
    EXPECT_EQ(host.status().rigs.size(), 1u);
    EXPECT_EQ(host.status().rigs[0].outages, 0u);
}

TEST_F(ReloadTest, ANewKeyOfTheHostIsUsedWithoutARestart) {
    const CurveKeys old_keys = generate_curve_keys(), new_keys = generate_curve_keys();
    Publisher rig(secured_stream({old_keys}), "rig-a");
    StageReceiver host(stage_of(rig, key_file_of(old_keys)));
    names_ = {"rig-a"};
    (void)frame_set_with(host, {&rig});
    // The rig admits both for as long as the keys are changed.
    authorize({old_keys, new_keys});
    follow(host, stage_of(rig, key_file_of(new_keys)));
    authorize({new_keys});
    ASSERT_TRUE(eventually([&] {
        const auto hosts = rig.status().hosts;
        const auto attached =
            std::count_if(hosts.begin(), hosts.end(), [](const auto& one) { return one.attached; });
        return attached == 1 && connected(host) && host.status().rigs[0].refused.empty();
    }));
    (void)frame_set_with(host, {&rig});
    const RigStatus status = host.status().rigs[0];
    EXPECT_EQ(status.refused, "");
    EXPECT_EQ(status.restarts, 0u);
}

TEST_F(ReloadTest, ARigWhoseKeyIsRevokedIsCutOffAtOnceAndItsNewKeyIsTakenLive) {
    const CurveKeys host_keys = generate_curve_keys();
    auto rig = std::make_unique<Publisher>(secured_stream({host_keys}), "rig-a");
    Publisher other(open_stream(), "other");
    StageConfig stage = stage_of(*rig, key_file_of(host_keys));
    stage.latency_budget_ms = 1000;
    stage.rigs.push_back({"other", other.endpoint(), ""});
    StageReceiver host(stage);
    names_ = {"rig-a", "other"};
    (void)frame_set_with(host, {rig.get(), &other});

    // The stage file states another key: whoever has the old one is a stranger.
    StageConfig revoked = stage;
    revoked.rigs[0].public_key = generate_curve_keys().public_key;
    follow(host, revoked);
    ASSERT_TRUE(eventually([&] { return !host.status().rigs[0].refused.empty(); }));
    EXPECT_THAT(host.status().rigs[0].refused, HasSubstr("does not have the key"));
    const std::uint64_t received = host.status().rigs[0].received;
    names_ = {"other"};
    for (int i = 0; i < 5; ++i) {
        rig->publish(make_frame(++pulse_));
        other.publish(make_frame(pulse_));
        ASSERT_TRUE(host.next(patience));
    }
    EXPECT_EQ(host.status().rigs[0].received, received);
    EXPECT_EQ(host.status().rigs[1].outages, 0u) << "the rig beside goes on";

    // The rig makes a new key, and the stage file follows.
    rig.reset();
    std::filesystem::remove(folder_.path() / "rig.key");
    rig = std::make_unique<Publisher>(secured_stream({host_keys}), "rig-a");
    stage.rigs[0] = {"rig-a", rig->endpoint(), rig->public_key()};
    follow(host, stage);
    names_ = {"rig-a", "other"};
    (void)frame_set_with(host, {rig.get(), &other});
    EXPECT_EQ(host.status().rigs[0].refused, "");
    EXPECT_GT(host.status().rigs[0].received, received);
    EXPECT_EQ(host.status().rigs[1].outages, 0u);
    EXPECT_EQ(host.status().rigs[1].lost, 0u);
}

}  // namespace
}  // namespace vantage
