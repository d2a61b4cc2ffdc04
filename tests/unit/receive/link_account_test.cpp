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

TEST(LinkAccount, FindsLossesByTheNextFrameOrHeartbeat) {
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

TEST(LinkAccount, ACountThatGoesBackwardsIsRefusedAndChangesNothing) {
    LinkAccount account;
    account.hear(message_of(1, 1), true);
    account.hear(message_of(1, 2), true);
    EXPECT_THROW(account.hear(message_of(1, 2), true), Error);
    EXPECT_THROW(account.hear(message_of(1, 1), false), Error);
    EXPECT_EQ(account.known(), 2u);
    EXPECT_EQ(account.lost(), 0u);
}

}  // namespace
}  // namespace vantage
