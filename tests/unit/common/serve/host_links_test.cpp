#include "common/serve/host_links.h"

#include <chrono>
#include <map>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/wire/limits.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;

constexpr std::size_t queue_frames = 3;

std::shared_ptr<const PackedFrame> frame_of(std::uint64_t index, bool is_raw_pair = false) {
    auto frame = std::make_shared<PackedFrame>();
    frame->trigger_index = index;
    frame->is_raw_pair = is_raw_pair;
    return frame;
}

class HostLinksTest : public testing::Test {
  protected:
    /// The host says hello on this route, and grants `window` frames once it knows its link.
    void attach(const std::string& route, std::uint64_t host_id, std::uint32_t window,
                const std::string& key = "key") {
        HostMessage message;
        message.host_id = host_id;
        links_.hear(route, key, message, now_);
        for (const auto& outgoing : links_.take())
            if (outgoing.route == route) message.link = outgoing.message.link;
        message.credit_window = window;
        links_.hear(route, key, message, now_);
        link_ = message.link;
    }

    void offer(std::uint64_t first, std::uint64_t last) {
        for (std::uint64_t k = first; k <= last; ++k) links_.offer(frame_of(k));
    }

    static std::vector<std::uint64_t> indices(const std::vector<HostLinks::Outgoing>& all) {
        std::vector<std::uint64_t> result;
        for (const auto& outgoing : all)
            if (outgoing.frame) result.push_back(outgoing.frame->trigger_index);
        return result;
    }

    HostLinks links_{"rig-a", 42, queue_frames};
    MonotonicTime now_ = monotonic_from_ns(1'000'000'000);
    std::uint64_t link_ = 0;
};

TEST_F(HostLinksTest, PublishesNothingWithoutHosts) {
    offer(1, 3);
    EXPECT_TRUE(links_.take().empty());
    EXPECT_EQ(links_.rig_counters().published, 3u);
    EXPECT_EQ(links_.rig_counters().send_dropped, 0u);
}

TEST_F(HostLinksTest, AHostIsSentNoFrameBeforeItGrantsCreditOnItsLink) {
    HostMessage message;
    message.host_id = 5;
    message.credit_window = 9;
    links_.hear("r1", "key", message, now_);
    offer(1, 2);
    const auto welcome = links_.take();
    ASSERT_EQ(welcome.size(), 1u);
    EXPECT_FALSE(welcome[0].frame);
    EXPECT_NE(welcome[0].message.link, 0u);
    EXPECT_EQ(welcome[0].message.rig, "rig-a");
    EXPECT_EQ(welcome[0].message.session, 42u);

    message.link = welcome[0].message.link;
    links_.hear("r1", "key", message, now_);
    EXPECT_THAT(indices(links_.take()), testing::ElementsAre(1, 2));
}

TEST_F(HostLinksTest, CreditBoundsSentFramesAndTheQueueDropsTheOldest) {
    attach("r1", 5, 2);
    offer(1, 8);
    // Nothing was taken in between, so all of them met the queue.
    EXPECT_THAT(indices(links_.take()), testing::ElementsAre(6, 7));
    EXPECT_TRUE(links_.take().empty());
    const LinkCounters counters = links_.hosts().at(0).counters;
    EXPECT_EQ(counters, (LinkCounters{8, 2, 5, 0}));
    EXPECT_EQ(links_.hosts().at(0).queued, 1u);
    EXPECT_EQ(links_.rig_counters().send_dropped, 5u);
}

TEST_F(HostLinksTest, ReportsFramesDroppedForSlowHostsOnce) {
    attach("route", 7, 2);
    offer(1, 8);
    (void)links_.take();
    EXPECT_GT(links_.hosts()[0].counters.send_dropped, 0u);
    const HostLinks::Overrun overrun = links_.take_overrun();
    EXPECT_EQ(overrun.frames, links_.hosts()[0].counters.send_dropped);
    EXPECT_EQ(overrun.host, "host key");
    EXPECT_EQ(links_.take_overrun().frames, 0u);
}

TEST_F(HostLinksTest, AddsRefusedConnectionsToThoseOfTheRelayedRig) {
    RigHealth health;
    health.refused_connections = 5;
    links_.set_health(health);
    links_.set_refused_connections(2);
    attach("route", 7, 2);
    links_.ring();
    const auto heartbeats = links_.take();
    ASSERT_EQ(heartbeats.size(), 1u);
    EXPECT_EQ(heartbeats[0].message.health.refused_connections, 7u);
    EXPECT_EQ(links_.health().refused_connections, 5u);
}

TEST_F(HostLinksTest, HandledFramesReturnCredit) {
    attach("r1", 5, 1);
    offer(1, 3);
    EXPECT_THAT(indices(links_.take()), testing::ElementsAre(1));
    HostMessage message;
    message.host_id = 5;
    message.link = link_;
    message.handled = 1;
    message.credit_window = 1;
    links_.hear("r1", "key", message, now_);
    EXPECT_THAT(indices(links_.take()), testing::ElementsAre(2));
}

TEST_F(HostLinksTest, AHostCannotGainCreditByFalseCounts) {
    attach("r1", 5, 1);
    HostMessage message;
    message.host_id = 5;
    message.link = link_;
    message.handled = ~std::uint64_t{0};
    message.credit_window = 1;
    links_.hear("r1", "key", message, now_);
    offer(1, 3);
    EXPECT_THAT(indices(links_.take()), testing::ElementsAre(1));
}

TEST_F(HostLinksTest, EachHostHasItsOwnCreditQueueAndCount) {
    attach("r1", 5, 3);
    attach("r2", 6, 1);
    offer(1, 3);
    const auto all = links_.take();
    std::map<std::string, std::vector<std::uint64_t>> by_route;
    for (const auto& outgoing : all) {
        by_route[outgoing.route].push_back(outgoing.frame->trigger_index);
        EXPECT_EQ(outgoing.message.counters.sent, by_route[outgoing.route].size());
    }
    EXPECT_THAT(by_route["r1"], testing::ElementsAre(1, 2, 3));
    EXPECT_THAT(by_route["r2"], testing::ElementsAre(1));
}

TEST_F(HostLinksTest, SkipsFramesByPulseNotByCount) {
    attach("r1", 5, 16);
    HostMessage message;
    message.host_id = 5;
    message.link = link_;
    message.credit_window = 16;
    message.rate_divisor = 3;
    links_.hear("r1", "key", message, now_);
    offer(10, 16);
    EXPECT_THAT(indices(links_.take()), testing::ElementsAre(12, 15));
    message.streaming = false;
    links_.hear("r1", "key", message, now_);
    offer(17, 19);
    EXPECT_TRUE(links_.take().empty());
    EXPECT_EQ(links_.hosts().at(0).counters, (LinkCounters{10, 2, 0, 8}));
}

TEST_F(HostLinksTest, ASilentHostIsRemovedAndItsQueueCounted) {
    attach("r1", 5, 1);
    offer(1, 3);
    links_.take();
    now_ += 1s;
    links_.expire(now_);
    EXPECT_TRUE(links_.hosts().at(0).attached);
    now_ += 5s;
    links_.expire(now_);
    EXPECT_FALSE(links_.hosts().at(0).attached);
    offer(4, 9);
    EXPECT_TRUE(links_.take().empty());
    EXPECT_EQ(links_.hosts().at(0).counters, (LinkCounters{3, 1, 2, 0}));
}

TEST_F(HostLinksTest, AReconnectedHostKeepsItsCounts) {
    attach("r1", 5, 2);
    offer(1, 2);
    links_.take();
    HostMessage message;
    message.host_id = 5;
    message.link = link_;
    message.handled = 2;
    message.credit_window = 2;
    links_.hear("r9", "key", message, now_);
    offer(3, 3);
    const auto all = links_.take();
    ASSERT_EQ(all.size(), 1u);
    EXPECT_EQ(all[0].route, "r9");
    EXPECT_EQ(all[0].message.counters.sent, 3u);
    EXPECT_EQ(links_.hosts().size(), 1u);
}

TEST_F(HostLinksTest, TheSameIdUnderAnotherKeyIsAnotherHost) {
    attach("r1", 5, 2, "key-a");
    const std::uint64_t first = link_;
    attach("r2", 5, 2, "key-b");
    EXPECT_NE(link_, first);
    EXPECT_EQ(links_.hosts().size(), 2u);
}

TEST_F(HostLinksTest, FramesTheSocketCouldNotTakeCountAsDroppedNotAsSent) {
    attach("r1", 5, 2);
    offer(1, 3);
    for (const auto& outgoing : links_.take()) links_.undelivered(outgoing);
    EXPECT_FALSE(links_.hosts().at(0).attached);
    EXPECT_EQ(links_.hosts().at(0).counters, (LinkCounters{3, 0, 3, 0}));
    EXPECT_EQ(links_.rig_counters().send_dropped, 3u);
}

TEST_F(HostLinksTest, AtItsLimitItForgetsTheLongestAbsentHostOrRefuses) {
    for (std::uint64_t host = 1; host <= HostLinks::max_hosts; ++host)
        attach("r" + std::to_string(host), host, 1);
    HostMessage message;
    message.host_id = 99;
    links_.hear("r99", "key", message, now_);
    const auto refused = links_.take();
    ASSERT_EQ(refused.size(), 1u);
    EXPECT_EQ(refused[0].route, "r99");
    EXPECT_THAT(refused[0].message.refusal, testing::HasSubstr("16 hosts"));

    now_ += 5s;
    links_.expire(now_);
    links_.hear("r99", "key", message, now_);
    EXPECT_EQ(links_.hosts().size(), HostLinks::max_hosts);
    EXPECT_TRUE(links_.hosts().back().attached);
}

TEST_F(HostLinksTest, AFloodOfBadMessagesGetsABoundedNumberOfAnswers) {
    for (int i = 0; i < 1000; ++i) links_.refuse("r1", "no");
    EXPECT_LE(links_.take().size(), 32u);
}

TEST_F(HostLinksTest, HeartbeatsGoToAttachedHostsAndCarryTheNewestCounts) {
    attach("r1", 5, 1);
    links_.set_rig_counters({100, 7, 3, 0, 0});
    links_.set_rig_counters({90, 7, 2, 0, 0});
    links_.ring();
    const auto all = links_.take();
    ASSERT_EQ(all.size(), 1u);
    EXPECT_EQ(all[0].message.rig_counters, (RigCounters{100, 7, 3, 0, 0}));
    EXPECT_TRUE(links_.take().empty());
}

TEST_F(HostLinksTest, RawPairsGoToHostsThatRequestThemAndViewsToOthers) {
    attach("films", 5, 9);
    HostMessage request;
    request.host_id = 6;
    request.raw_pairs = true;
    request.rate_divisor = 2;
    request.credit_window = 9;
    EXPECT_FALSE(links_.wants_raw_pair(4));
    links_.hear("calibrates", "key", request, now_);
    for (const auto& outgoing : links_.take()) request.link = outgoing.message.link;
    links_.hear("calibrates", "key", request, now_);
    EXPECT_TRUE(links_.wants_raw_pair(4));
    EXPECT_FALSE(links_.wants_raw_pair(5));

    links_.offer(frame_of(4));
    links_.offer(frame_of(4, true));
    const auto all = links_.take();
    ASSERT_EQ(indices(all).size(), 2u);
    for (const auto& outgoing : all)
        EXPECT_EQ(outgoing.frame->is_raw_pair, outgoing.route == "calibrates");
    EXPECT_EQ(links_.rig_counters().published, 1u) << "one instant";
    for (const auto& host : links_.hosts()) EXPECT_EQ(host.counters, (LinkCounters{1, 1, 0, 0}));

    request.streaming = false;
    links_.hear("calibrates", "key", request, now_);
    EXPECT_FALSE(links_.wants_raw_pair(4));
}

TEST_F(HostLinksTest, ARigWithoutViewsRefusesThemAndServesRawPairs) {
    links_.serve_raw_pairs_only("no calibration yet");
    HostMessage request;
    request.host_id = 5;
    links_.hear("films", "key", request, now_);
    const auto refusals = links_.take();
    ASSERT_EQ(refusals.size(), 1u);
    EXPECT_EQ(refusals[0].message.refusal, "no calibration yet");
    EXPECT_TRUE(links_.hosts().empty());

    request.raw_pairs = true;
    request.host_id = 6;
    links_.hear("calibrates", "key", request, now_);
    EXPECT_EQ(links_.hosts().size(), 1u);
    links_.offer(frame_of(1, true));
    links_.pass_over();
    EXPECT_EQ(links_.rig_counters().published, 2u);
}

/// A host that fetches, and what the rig's reader answers.
class HostLinksFetchTest : public HostLinksTest {
  protected:
    void ask(std::uint64_t host_id, FetchRequest request) {
        HostMessage message;
        message.host_id = host_id;
        message.streaming = false;
        message.fetch = request;
        links_.hear(fmt::format("r{}", host_id), "key", message, now_);
    }
    void answer(const HostLinks::FetchJob& job, std::uint64_t pulse) {
        auto kept = std::make_shared<KeptParts>();
        kept->pulse = pulse;
        links_.fetched(job, kept, "");
    }
    /// What is sent now: of each message the pulse that it brings, and how the fetch stands.
    std::vector<std::pair<std::uint64_t, FetchState>> sent() {
        std::vector<std::pair<std::uint64_t, FetchState>> all;
        for (const auto& outgoing : links_.take())
            if (outgoing.message.fetch)
                all.emplace_back(outgoing.kept ? outgoing.kept->pulse : 0, *outgoing.message.fetch);
        return all;
    }
};

TEST_F(HostLinksFetchTest, SendsWithinCreditAndReportsTheEnd) {
    links_.serve_kept();
    ask(5, {7, 100, 110, 0});
    EXPECT_FALSE(links_.next_fetch());
    ask(5, {7, 100, 110, 1});
    auto job = links_.next_fetch();
    ASSERT_TRUE(job);
    EXPECT_EQ(job->from_pulse, 100u);
    EXPECT_EQ(job->to_pulse, 110u);
    EXPECT_FALSE(links_.next_fetch()) << "one job at a time";
    answer(*job, 103);
    EXPECT_FALSE(links_.next_fetch()) << "credit is used up";
    ask(5, {7, 100, 110, 2});
    job = links_.next_fetch();
    ASSERT_TRUE(job);
    EXPECT_EQ(job->from_pulse, 104u);
    links_.fetched(*job, nullptr, "");
    const auto all = sent();
    ASSERT_FALSE(all.empty());
    EXPECT_EQ(all.back(), (std::pair<std::uint64_t, FetchState>{103, {7, 1, true, ""}}));
    EXPECT_FALSE(links_.next_fetch());
    EXPECT_EQ(links_.hosts()[0].fetched, 1u);
}

TEST_F(HostLinksFetchTest, AnotherIdRestartsTheFetch) {
    links_.serve_kept();
    ask(5, {7, 100, 110, 4});
    const auto job = links_.next_fetch();
    ask(5, {8, 200, 210, 4});
    answer(*job, 100);
    for (const auto& [pulse, state] : sent()) EXPECT_EQ(pulse, 0u);
    EXPECT_EQ(links_.next_fetch()->from_pulse, 200u);
}

TEST_F(HostLinksFetchTest, ServesHostsInTurnWithinBoundedCredit) {
    links_.serve_kept();
    ask(5, {7, 0, 1000, ~std::uint64_t{0}});
    ask(6, {9, 0, 1000, ~std::uint64_t{0}});
    std::map<std::uint64_t, int> jobs;
    for (int i = 0; i < 100; ++i) {
        const auto job = links_.next_fetch();
        if (!job) break;
        ++jobs[job->fetch];
        answer(*job, job->from_pulse);
    }
    EXPECT_EQ(jobs[7], static_cast<int>(max_credit_window)) << "whatever it grants";
    EXPECT_EQ(jobs[9], static_cast<int>(max_credit_window));
}

TEST_F(HostLinksFetchTest, ARigWithoutRecordingsRefusesAndCounts) {
    ask(5, {7, 100, 110, 4});
    EXPECT_FALSE(links_.next_fetch());
    const auto all = sent();
    ASSERT_FALSE(all.empty());
    EXPECT_NE(all.back().second.trouble, "");
    EXPECT_EQ(links_.refused_fetches(), 1u);
    ask(5, {7, 100, 110, 5});
    EXPECT_EQ(links_.refused_fetches(), 1u) << "the same request again";
}

TEST_F(HostLinksFetchTest, NothingIsLookedUpForADisconnectedHost) {
    links_.serve_kept();
    ask(5, {7, 100, 110, 4});
    links_.expire(now_ + 10s);
    EXPECT_FALSE(links_.next_fetch());
}

std::shared_ptr<const PackedFrame> large_frame_of(std::uint64_t index, std::size_t bytes) {
    auto frame = std::make_shared<PackedFrame>();
    frame->trigger_index = index;
    frame->colour.resize(bytes);
    return frame;
}

class HostRoadsTest : public HostLinksTest {
  protected:
    void open_road(std::size_t room_bytes) {
        const auto peers = links_.datagram_peers();
        ASSERT_EQ(peers.size(), 1u);
        EXPECT_EQ(peers[0].link, link_);
        DatagramServer::Road road;
        road.offer = {7, 5600, "a passphrase of a test"};
        road.is_open = room_bytes > 0;
        road.room_bytes = room_bytes;
        links_.set_roads(peers, {road});
    }
    static std::vector<bool> roads(const std::vector<HostLinks::Outgoing>& all) {
        std::vector<bool> result;
        for (const auto& outgoing : all)
            if (outgoing.frame) result.push_back(outgoing.by_datagrams);
        return result;
    }
};

TEST_F(HostRoadsTest, TheOfferIsToldAtOnceAndItsPassphraseBesideNoFrame) {
    attach("r1", 5, 9);
    open_road(0);
    offer(1, 1);
    const auto all = links_.take();
    ASSERT_EQ(all.size(), 2u);
    EXPECT_EQ(all[0].message.offer.passphrase, "a passphrase of a test");
    EXPECT_FALSE(all[1].by_datagrams);
    EXPECT_EQ(all[1].message.offer.id, 7u);
    EXPECT_EQ(all[1].message.offer.passphrase, "");
    EXPECT_EQ(all[1].message.sent_by_datagrams, 0u);
}

TEST_F(HostRoadsTest, FramesWaitForRoomAndTheOldestIsDroppedAndCounted) {
    attach("r1", 5, 9);
    constexpr std::size_t bytes = 100'000;
    open_road(2 * bytes + 20'000);
    for (std::uint64_t k = 1; k <= 3; ++k) links_.offer(large_frame_of(k, bytes));
    const auto first = links_.take();
    EXPECT_THAT(indices(first), testing::ElementsAre(1, 2));
    EXPECT_THAT(roads(first), testing::ElementsAre(true, true));
    EXPECT_EQ(first.back().message.sent_by_datagrams, 2u);
    EXPECT_TRUE(links_.waits_for_room());
    for (std::uint64_t k = 4; k <= 6; ++k) links_.offer(large_frame_of(k, bytes));
    EXPECT_TRUE(indices(links_.take()).empty());
    open_road(4 * bytes + 40'000);
    EXPECT_THAT(indices(links_.take()), testing::ElementsAre(4, 5, 6));
    EXPECT_FALSE(links_.waits_for_room());
    const LinkCounters counters = links_.hosts().at(0).counters;
    EXPECT_EQ(counters.offered, 6u);
    EXPECT_EQ(counters.sent, 5u);
    EXPECT_EQ(counters.send_dropped, 1u);
}

TEST_F(HostRoadsTest, AHostIsGrantedMoreWhileItsRoadIsOpen) {
    HostLinks links("rig-a", 42, max_datagram_credit_window);
    HostMessage message;
    message.host_id = 5;
    message.credit_window = max_datagram_credit_window;
    links.hear("r1", "key", message, now_);
    message.link = links.take().at(0).message.link;
    links.hear("r1", "key", message, now_);
    for (std::uint64_t k = 1; k <= max_datagram_credit_window; ++k) links.offer(frame_of(k));
    EXPECT_EQ(links.take().size(), max_credit_window);
    DatagramServer::Road road;
    road.is_open = true;
    road.room_bytes = 100 << 20;
    links.set_roads(links.datagram_peers(), {road});
    links.hear("r1", "key", message, now_);
    EXPECT_EQ(links.take().size(), max_datagram_credit_window - max_credit_window);
}

TEST_F(HostRoadsTest, AFrameBeyondTheLimitGoesOverTcp) {
    attach("r1", 5, 9);
    open_road(1 << 20);
    links_.offer(large_frame_of(1, max_datagram_message_bytes));
    EXPECT_THAT(roads(links_.take()), testing::ElementsAre(false));
}

TEST_F(HostRoadsTest, ARoadThatEndsUnderAFrameCostsThatFrameAndNotTheHost) {
    attach("r1", 5, 9);
    open_road(1 << 20);
    offer(1, 1);
    const auto sent = links_.take();
    ASSERT_TRUE(sent.back().by_datagrams);
    links_.undelivered(sent.back());
    offer(2, 2);
    const auto next = links_.take();
    EXPECT_THAT(roads(next), testing::ElementsAre(false));
    EXPECT_EQ(next.back().message.sent_by_datagrams, 0u);
    EXPECT_TRUE(links_.hosts().at(0).attached);
    EXPECT_EQ(links_.hosts().at(0).counters.sent, 1u);
    EXPECT_EQ(links_.hosts().at(0).counters.send_dropped, 1u);
}

}  // namespace
}  // namespace vantage
