#include "common/receive/link_account.h"

#include <gtest/gtest.h>

#include "common/base/error.h"

namespace vantage {
namespace {

RigMessage message_of(std::uint64_t link, std::uint64_t sent) {
    RigMessage message;
    message.rig = "rig-a";
    message.link = link;
    message.counters.sent = sent;
    return message;
}

TEST(LinkAccount, CountsNothingLostWhileFramesFollowEachOther) {
    LinkAccount account;
    EXPECT_EQ(account.hear(message_of(1, 0), false), 0u);
    for (std::uint64_t sent = 1; sent < 5; ++sent)
        EXPECT_EQ(account.hear(message_of(1, sent), true), 0u);
    EXPECT_EQ(account.hear(message_of(1, 4), false), 0u);
    EXPECT_EQ(account.known(), 4u);
    EXPECT_EQ(account.lost(), 0u);
}

TEST(LinkAccount, DetectsLossesWithTheNextFrameOrHeartbeat) {
    LinkAccount account;
    account.hear(message_of(1, 1), true);
    EXPECT_EQ(account.hear(message_of(1, 4), true), 2u);
    EXPECT_EQ(account.hear(message_of(1, 7), false), 3u);
    EXPECT_EQ(account.known(), 7u);
    EXPECT_EQ(account.lost(), 5u);
}

TEST(LinkAccount, ANewLinkStartsItsOwnCount) {
    LinkAccount account;
    account.hear(message_of(1, 1), true);
    EXPECT_EQ(account.hear(message_of(2, 1), true), 0u);
    EXPECT_EQ(account.link(), 2u);
    EXPECT_EQ(account.known(), 1u);
    EXPECT_EQ(account.hear(message_of(3, 3), true), 2u);
}

TEST(LinkAccount, RefusesADecreasingCount) {
    LinkAccount account;
    account.hear(message_of(1, 1), true);
    account.hear(message_of(1, 2), true);
    EXPECT_THROW(account.hear(message_of(1, 2), true), Error);
    EXPECT_THROW(account.hear(message_of(1, 1), false), Error);
    EXPECT_EQ(account.known(), 2u);
    EXPECT_EQ(account.lost(), 0u);
}

RigMessage message_of_roads(std::uint64_t offer, std::uint64_t sent,
                            std::uint64_t sent_by_datagrams, std::uint64_t link = 1) {
    RigMessage message = message_of(link, sent);
    message.offer.id = offer;
    message.sent_by_datagrams = sent_by_datagrams;
    return message;
}

TEST(LinkAccount, FramesByDatagramsAreUnderWayWhileTheirRoadIsOpen) {
    LinkAccount account;
    account.hear(message_of_roads(7, 2, 0), true);
    EXPECT_EQ(account.lost(), 1u);
    // The heartbeat overtakes four frames by datagrams.
    EXPECT_EQ(account.hear(message_of_roads(7, 6, 4), false), 0u);
    EXPECT_EQ(account.known(), 2u);
    for (std::uint64_t k = 1; k <= 3; ++k)
        EXPECT_EQ(account.hear_datagrams(message_of_roads(7, 2 + k, k)), 0u);
    EXPECT_EQ(account.known(), 5u);
    EXPECT_EQ(account.handled(1), 4u);
    EXPECT_EQ(account.link_counters().sent, 6u) << "an older message changes no counts";
    // The road ended with the fourth on it, and the next frame comes over TCP.
    EXPECT_EQ(account.hear(message_of_roads(0, 7, 4), true), 1u);
    EXPECT_EQ(account.known(), 7u);
    EXPECT_EQ(account.lost(), 2u);
    EXPECT_THROW(account.hear_datagrams(message_of_roads(7, 6, 4)), Error);
    // A new offer, whose road goes on counting.
    account.hear(message_of_roads(8, 7, 4), false);
    EXPECT_EQ(account.hear_datagrams(message_of_roads(8, 8, 5)), 0u);
    EXPECT_EQ(account.known(), 8u);
    EXPECT_EQ(account.lost(), 2u);
}

TEST(LinkAccount, AFrameOverTcpMayComeAfterLaterOnesByDatagrams) {
    LinkAccount account;
    account.hear(message_of_roads(7, 0, 0), false);
    EXPECT_EQ(account.hear_datagrams(message_of_roads(7, 2, 1)), 0u);
    EXPECT_EQ(account.hear(message_of_roads(7, 1, 0), true), 0u);
    EXPECT_EQ(account.known(), 2u);
    EXPECT_EQ(account.lost(), 0u);
}

TEST(LinkAccount, DetectsAGapOnTheRoadOfDatagrams) {
    LinkAccount account;
    account.hear(message_of_roads(7, 0, 0), false);
    EXPECT_EQ(account.hear_datagrams(message_of_roads(7, 3, 3)), 2u);
    EXPECT_THROW(account.hear_datagrams(message_of_roads(7, 3, 3)), Error);
    EXPECT_EQ(account.known(), 3u);
}

TEST(LinkAccount, FramesByDatagramsOfAnEndedLinkAreLost) {
    LinkAccount account;
    account.hear(message_of_roads(7, 3, 3), false);
    account.hear_datagrams(message_of_roads(7, 4, 4));
    EXPECT_EQ(account.lost(), 3u);
    account.hear(message_of_roads(7, 6, 6), false);
    EXPECT_EQ(account.hear(message_of_roads(9, 1, 0, 2), true), 2u);
    EXPECT_EQ(account.lost(), 5u);
    EXPECT_EQ(account.known(), 1u);
    EXPECT_EQ(account.link_counters().sent, 7u);
}

RigMessage message_of_session(std::uint64_t session, const LinkCounters& link,
                              const RigCounters& rig) {
    RigMessage message = message_of(session, link.sent);
    message.session = session;
    message.counters = link;
    message.rig_counters = rig;
    return message;
}

TEST(LinkAccount, SumsARigsCountsOverRestarts) {
    LinkAccount account;
    account.hear(message_of_session(1, {0, 0, 0, 0}, {}), false);
    account.hear(message_of_session(1, {10, 1, 2, 3}, {12, 1, 1, 10, 2}), true);
    account.hear(message_of_session(2, {4, 1, 0, 1}, {5, 2, 0, 4, 0}), true);
    EXPECT_EQ(account.restarts(), 1u);
    EXPECT_EQ(account.link_counters(), (LinkCounters{14, 2, 2, 4}));
    EXPECT_EQ(account.rig_counters(), (RigCounters{17, 3, 1, 14, 2}));
}

TEST(LinkAccount, SubtractsCountsFromBeforeThisHost) {
    LinkAccount account;
    // Two frames are inside the rig.
    account.hear(message_of_session(1, {}, {1002, 7, 30, 970, 5}), false);
    EXPECT_EQ(account.rig_counters(), (RigCounters{2, 0, 0, 0, 0}));
    account.hear(message_of_session(1, {3, 0, 0, 0}, {1003, 8, 30, 973, 5}), false);
    EXPECT_EQ(account.rig_counters(), (RigCounters{3, 1, 0, 3, 0}));
}

TEST(LinkAccount, HandledFramesAreThoseOfTheCurrentLink) {
    LinkAccount account;
    account.hear(message_of(1, 1), true);
    account.hear(message_of(1, 2), true);
    EXPECT_EQ(account.handled(1), 1u);
    account.hear(message_of(2, 1), true);
    EXPECT_EQ(account.handled(3), 0u);
}

}  // namespace
}  // namespace vantage
