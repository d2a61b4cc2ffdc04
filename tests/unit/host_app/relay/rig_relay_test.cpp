#include "host_app/relay/rig_relay.h"

#include <chrono>
#include <fstream>
#include <functional>
#include <initializer_list>
#include <map>
#include <mutex>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/receive/stage_receiver.h"
#include "common/wire/curve_keys.h"
#include "rig_firmware/stream/publisher.h"
#include "tests/support/data_folder.h"
#include "tests/support/eventually.h"
#include "tests/support/thrown_sentence.h"
#include "tests/support/wire_frames.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

/// What came to a host, by pulse.
class Tap {
  public:
    FrameTap tap() {
        return [this](const ArrivedFrame& frame) {
            const std::lock_guard lock(mutex_);
            came_[decode_frame_head(frame.packed->header).frame.trigger_index] = frame.packed;
        };
    }
    std::map<std::uint64_t, std::shared_ptr<const PackedFrame>> came() const {
        const std::lock_guard lock(mutex_);
        return came_;
    }

  private:
    mutable std::mutex mutex_;
    std::map<std::uint64_t, std::shared_ptr<const PackedFrame>> came_;
};

/// One rig, a relay and hosts, all with keys.
class RigRelayTest : public testing::Test {
  protected:
    RigRelayTest() {
        relay_keys_ = key_file("relay.key");
        authorize("rig.hosts", {relay_keys_});
        write_key_file(path("rig.key"), generate_curve_keys());
        first_ = key_file("first.key");
        second_ = key_file("second.key");
        authorize("relay.hosts", {first_, second_});
    }
    std::filesystem::path path(const std::string& name) const { return folder_.path() / name; }
    CurveKeys key_file(const std::string& name) const {
        const CurveKeys keys = generate_curve_keys();
        write_key_file(path(name), keys);
        return keys;
    }
    void authorize(const std::string& list, const std::vector<CurveKeys>& hosts) const {
        std::ofstream out(path(list));
        for (const CurveKeys& host : hosts) out << host.public_key << " a host\n";
    }
    RigConfig::Stream stream(const std::string& bind = "tcp://127.0.0.1:*") const {
        RigConfig::Stream stream;
        stream.bind = bind;
        stream.jpeg_quality = 0;
        stream.key_file = path("rig.key");
        stream.authorized_hosts = path("rig.hosts");
        return stream;
    }
    std::unique_ptr<RigRelay> relay_of(const Publisher& rig) const {
        StageConfig stage;
        stage.rigs.push_back({"rig-a", rig.endpoint(), rig.public_key()});
        stage.key_file = path("relay.key");
        return std::make_unique<RigRelay>(
            stage, RigRelay::Settings{"tcp://127.0.0.1:*", path("relay.hosts")});
    }
    StageConfig behind(const RigRelay& relay, const std::string& key) const {
        StageConfig stage;
        for (const RigRelay::Rig& rig : relay.status())
            stage.rigs.push_back({rig.name, rig.endpoint, rig.public_key});
        stage.key_file = path(key);
        stage.latency_budget_ms = 50;
        return stage;
    }
    static RigStatus of(const StageReceiver& host) { return host.status().rigs.at(0); }
    static bool streams(const Publisher& rig) {
        const auto hosts = rig.status().hosts;
        return !hosts.empty() && hosts.back().streaming;
    }
    /// A frame has come to all of these hosts before the next one is filmed.
    static void publish(Publisher& rig, std::uint64_t from, std::uint64_t to,
                        std::map<std::uint64_t, std::shared_ptr<const PackedFrame>>& sent,
                        std::initializer_list<const Tap*> hosts) {
        for (std::uint64_t k = from; k < to; ++k) {
            sent[k] = rig.publish(make_frame(k));
            for (const Tap* host : hosts)
                ASSERT_TRUE(eventually([&] { return host->came().contains(k); })) << "pulse " << k;
        }
    }

    TemporaryFolder folder_;
    CurveKeys relay_keys_, first_, second_;
};

TEST_F(RigRelayTest, ForwardsEveryFrameOnceFromTheRigToEveryHost) {
    Publisher rig(stream(), "rig-a");
    const std::unique_ptr<RigRelay> relay = relay_of(rig);
    Tap first, second;
    const StageReceiver one(behind(*relay, "first.key"), StageReceiver::Purpose::film, first.tap());
    const StageReceiver other(behind(*relay, "second.key"), StageReceiver::Purpose::film,
                              second.tap());
    ASSERT_TRUE(
        eventually([&] { return of(one).connected && of(other).connected && streams(rig); }));
    std::map<std::uint64_t, std::shared_ptr<const PackedFrame>> sent;
    publish(rig, 1000, 1040, sent, {&first, &second});
    for (const Tap* tap : {&first, &second})
        for (const auto& [pulse, frame] : tap->came()) {
            EXPECT_EQ(frame->header, sent[pulse]->header);
            EXPECT_EQ(frame->colour, sent[pulse]->colour);
            EXPECT_EQ(frame->disparity, sent[pulse]->disparity);
        }
    const PublisherStatus at_the_rig = rig.status();
    ASSERT_EQ(at_the_rig.hosts.size(), 1u) << "the rig serves the relay alone";
    EXPECT_EQ(at_the_rig.hosts[0].host_key, relay_keys_.public_key);
    EXPECT_EQ(at_the_rig.hosts[0].counters.sent, sent.size());
    for (const StageReceiver* host : {&one, &other}) {
        ASSERT_TRUE(eventually([&] { return of(*host).received == sent.size(); }));
        EXPECT_EQ(of(*host).link.sent, sent.size());
        EXPECT_EQ(of(*host).undecodable + of(*host).lost, 0u);
        EXPECT_EQ(of(*host).rig_counters.published, sent.size());
    }
}

TEST_F(RigRelayTest, ASlowHostDelaysNeitherTheRigNorOtherHosts) {
    Publisher rig(stream(), "rig-a");
    const std::unique_ptr<RigRelay> relay = relay_of(rig);
    std::mutex busy;
    std::unique_lock held(busy);
    Tap quick, slow;
    const StageReceiver one(behind(*relay, "first.key"), StageReceiver::Purpose::film, quick.tap());
    const StageReceiver other(behind(*relay, "second.key"), StageReceiver::Purpose::film,
                              [&, note = slow.tap()](const ArrivedFrame& frame) {
                                  const std::lock_guard wait(busy);
                                  note(frame);
                              });
    ASSERT_TRUE(
        eventually([&] { return of(one).connected && of(other).connected && streams(rig); }));
    std::map<std::uint64_t, std::shared_ptr<const PackedFrame>> sent;
    publish(rig, 1000, 1060, sent, {&quick});
    EXPECT_EQ(rig.status().counters.send_dropped, 0u);
    EXPECT_EQ(of(one).link.send_dropped, 0u);
    held.unlock();
    // It goes on with the newest frames; what was dropped for it is in its account.
    std::uint64_t newest = 2000;
    ASSERT_TRUE(eventually([&] {
        rig.publish(make_frame(++newest));
        const auto came = slow.came();
        return !came.empty() && came.rbegin()->first > 2000;
    }));
    ASSERT_TRUE(eventually([&] {
        const RigStatus it = of(other);
        return it.link.offered == it.link.sent + it.link.send_dropped &&
               it.received == it.link.sent;
    }));
    EXPECT_GT(of(other).link.send_dropped, 0u);
}

TEST_F(RigRelayTest, RequestsOnlyFramesThatAHostRequests) {
    Publisher rig(stream(), "rig-a");
    const std::unique_ptr<RigRelay> relay = relay_of(rig);
    ASSERT_TRUE(eventually([&] { return rig.status().hosts.size() == 1; }));
    rig.publish(make_frame(1));
    EXPECT_EQ(rig.status().hosts[0].counters.skipped, 1u) << "nobody wants it";
    Tap came;
    StageReceiver host(behind(*relay, "first.key"), StageReceiver::Purpose::film, came.tap());
    host.ask("rig-a", true, 2);
    ASSERT_TRUE(eventually([&] {
        const std::uint64_t k = 2 * rig.status().counters.published + 2;
        rig.publish(make_frame(k));
        std::this_thread::sleep_for(5ms);
        return came.came().contains(k);
    }));
    const LinkCounters before = rig.status().hosts[0].counters;
    rig.publish(make_frame(10'001));
    EXPECT_EQ(rig.status().hosts[0].counters.skipped, before.skipped + 1) << "every second one";
    EXPECT_FALSE(came.came().contains(10'001));
    // Hosts see in their account what was left out before it came to the relay.
    ASSERT_TRUE(eventually([&] { return of(host).link.skipped >= 1; }));
}

TEST_F(RigRelayTest, ReportsADisconnectedRigAndReconnects) {
    auto rig = std::make_unique<Publisher>(stream(), "rig-a");
    const std::string endpoint = rig->endpoint();
    const std::unique_ptr<RigRelay> relay = relay_of(*rig);
    Tap came;
    const StageReceiver host(behind(*relay, "first.key"), StageReceiver::Purpose::film, came.tap());
    ASSERT_TRUE(eventually([&] { return of(host).connected && streams(*rig); }));
    std::map<std::uint64_t, std::shared_ptr<const PackedFrame>> sent;
    publish(*rig, 1000, 1005, sent, {&came});
    const std::uint64_t session = rig->session();
    rig.reset();
    ASSERT_TRUE(eventually([&] { return !of(host).connected; }));
    ASSERT_TRUE(eventually([&] {
        return of(host).unreachable.find("the relay does not reach rig rig-a") != std::string::npos;
    }));
    EXPECT_EQ(of(host).refused, "") << "it comes back";
    EXPECT_EQ(of(host).restarts, 0u);
    rig = std::make_unique<Publisher>(stream(endpoint), "rig-a");
    ASSERT_NE(rig->session(), session);
    ASSERT_TRUE(eventually([&] { return of(host).connected && streams(*rig); }));
    publish(*rig, 1005, 1010, sent, {&came});
    ASSERT_TRUE(eventually([&] { return of(host).received == sent.size(); }));
    EXPECT_EQ(of(host).restarts, 1u);
    EXPECT_EQ(of(host).undecodable, 0u);
    EXPECT_EQ(of(host).rig_counters.published, sent.size());
}

TEST_F(RigRelayTest, AHostMayConnectBeforeItsRig) {
    StageConfig stage;
    auto rig = std::make_unique<Publisher>(stream(), "rig-a");
    const std::string endpoint = rig->endpoint(), key = rig->public_key();
    rig.reset();
    stage.rigs.push_back({"rig-a", endpoint, key});
    stage.key_file = path("relay.key");
    const RigRelay relay(stage, {"tcp://127.0.0.1:*", path("relay.hosts")});
    Tap came;
    const StageReceiver host(behind(relay, "first.key"), StageReceiver::Purpose::film, came.tap());
    ASSERT_TRUE(
        eventually([&] { return of(host).unreachable.find("relay") != std::string::npos; }));
    EXPECT_EQ(of(host).refused, "");
    rig = std::make_unique<Publisher>(stream(endpoint), "rig-a");
    ASSERT_TRUE(eventually([&] { return of(host).connected && streams(*rig); }));
    EXPECT_EQ(of(host).unreachable, "");
    std::map<std::uint64_t, std::shared_ptr<const PackedFrame>> sent;
    publish(*rig, 1000, 1005, sent, {&came});
}

TEST_F(RigRelayTest, AdmitsListedHostsOnlyAndIsItselfAdmittedByItsKey) {
    Publisher rig(stream(), "rig-a");
    const std::unique_ptr<RigRelay> relay = relay_of(rig);
    const CurveKeys stranger = key_file("stranger.key");
    const StageReceiver host(behind(*relay, "stranger.key"));
    ASSERT_TRUE(eventually([&] { return !of(host).refused.empty(); }));
    EXPECT_THAT(of(host).refused, HasSubstr(stranger.public_key));
    EXPECT_TRUE(relay->status()[0].hosts.empty());

    authorize("rig.hosts", {});
    Publisher strict(stream(), "rig-a");
    const std::unique_ptr<RigRelay> refused = relay_of(strict);
    ASSERT_TRUE(eventually([&] { return !refused->status()[0].trouble.empty(); }));
    EXPECT_THAT(refused->status()[0].trouble, HasSubstr(relay_keys_.public_key));
}

TEST_F(RigRelayTest, ForwardsReportsButNoRawPairs) {
    Publisher rig(stream(), "rig-a");
    rig.serve_reports([](const std::atomic<bool>&) { return std::string("report"); });
    const std::unique_ptr<RigRelay> relay = relay_of(rig);
    StageReceiver host(behind(*relay, "first.key"), StageReceiver::Purpose::observe);
    ASSERT_TRUE(eventually([&] { return of(host).connected; }));
    host.ask_for_reports();
    ASSERT_TRUE(eventually([&] { return host.report_of(0) != nullptr; }));
    EXPECT_EQ(*host.report_of(0), "report");
    const StageReceiver calibrating(behind(*relay, "second.key"),
                                    StageReceiver::Purpose::calibrate);
    ASSERT_TRUE(eventually([&] { return !of(calibrating).refused.empty(); }));
    EXPECT_THAT(of(calibrating).refused, HasSubstr("not forward raw pairs"));
}

TEST_F(RigRelayTest, RefusesOpenSettings) {
    StageConfig stage;
    stage.rigs.push_back({"rig-a", "tcp://127.0.0.1:5600", ""});
    const auto sentence = [&](const RigRelay::Settings& settings) {
        return thrown_sentence([&] { RigRelay(stage, settings); });
    };
    EXPECT_THAT(sentence({"tcp://*:5700"}), HasSubstr("--authorized-hosts"));
    EXPECT_THAT(sentence({"tcp://*:5700", path("relay.hosts")}), HasSubstr("key_file"));
    stage.rigs.push_back({"rig-b", "tcp://127.0.0.1:5601", ""});
    EXPECT_THAT(sentence({"tcp://127.0.0.1:65535"}), HasSubstr("no ports for 2 rigs"));
    stage.rigs.pop_back();
    const RigRelay first(stage, {"tcp://127.0.0.1:*"});
    const std::string taken = first.status()[0].endpoint;
    EXPECT_THAT(sentence({taken}), HasSubstr("another --listen"));
}

}  // namespace
}  // namespace vantage
