#include "host_app/replay/transport.h"

#include <gtest/gtest.h>

namespace vantage {
namespace {

class TransportTest : public testing::Test {
  protected:
    void travel(double pulses, std::uint64_t shown) { transport_.travel(pulses, shown, span_); }

    Transport transport_;
    std::optional<ReplayBuffer::Span> span_ = ReplayBuffer::Span{.oldest = 100, .newest = 160};
};

TEST_F(TransportTest, IsLiveUntilSomebodySaysOtherwise) {
    EXPECT_TRUE(transport_.is_live());
    EXPECT_FALSE(transport_.is_held());
    EXPECT_FALSE(transport_.pulse());
}

TEST_F(TransportTest, HoldsAndLetsGo) {
    transport_.toggle_hold();
    EXPECT_TRUE(transport_.is_held());
    EXPECT_FALSE(transport_.is_live());
    EXPECT_FALSE(transport_.pulse()) << "held is the instant that is shown, wherever it is from";
    transport_.toggle_hold();
    EXPECT_TRUE(transport_.is_live());
}

TEST_F(TransportTest, GoesFromThePulseThatIsShownAndStaysThere) {
    travel(-3, 155);
    EXPECT_EQ(transport_.pulse(), 152);
    EXPECT_FALSE(transport_.is_live());
    span_->newest = 170;
    travel(0, 152);
    EXPECT_EQ(transport_.pulse(), 152) << "the stage goes on and the past does not";
}

TEST_F(TransportTest, AddsUpPartsOfAPulse) {
    travel(-2, 150);
    for (int i = 0; i < 8; ++i) travel(0.25, 148);
    EXPECT_DOUBLE_EQ(*transport_.pulse(), 150) << "what is shown meanwhile does not round it";
}

TEST_F(TransportTest, StopsAtBothEndsOfWhatIsKept) {
    travel(-1000, 155);
    EXPECT_EQ(transport_.pulse(), 100);
    travel(+1000, 100);
    EXPECT_EQ(transport_.pulse(), 160);
    EXPECT_FALSE(transport_.is_live()) << "at the newest pulse of the past, not live";
}

TEST_F(TransportTest, MovesOnFromWhatTheBufferHasDropped) {
    travel(-1000, 155);
    span_ = ReplayBuffer::Span{.oldest = 130, .newest = 190};
    travel(+1, 100);
    EXPECT_EQ(transport_.pulse(), 130);
}

TEST_F(TransportTest, StaysLiveWhereNoPastIsKept) {
    span_.reset();
    travel(-3, 155);
    EXPECT_TRUE(transport_.is_live());
}

TEST_F(TransportTest, ComesBackToLiveFromHoldAndPast) {
    transport_.toggle_hold();
    travel(-3, 155);
    EXPECT_TRUE(transport_.is_held()) << "going through the past lets go of nothing";
    transport_.to_live();
    EXPECT_TRUE(transport_.is_live());
    EXPECT_FALSE(transport_.pulse());
}

}  // namespace
}  // namespace vantage
