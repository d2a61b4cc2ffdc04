#include "common/receive/take_starter.h"

#include <gtest/gtest.h>

namespace vantage {
namespace {

using namespace std::chrono_literals;

class TakeStarterTest : public testing::Test {
  protected:
    TakeStarterTest() : rigs_(3) {
        for (TakeStarter::Rig& rig : rigs_) rig = {.connected = true, .sync = {}};
    }
    std::optional<std::uint64_t> update(std::chrono::nanoseconds after) {
        return starter_.update(rigs_, tai_ + after, monotonic_ + after);
    }
    void make_ready(std::size_t rig) { rigs_[rig].sync.ready = true; }

    const TaiTime tai_ = tai_from_ns(1'795'000'000'000'000'000);
    const MonotonicTime monotonic_ = monotonic_from_ns(5'000'000'000);
    const PulseGrid grid_{30};
    TakeStarter starter_{grid_};
    std::vector<TakeStarter::Rig> rigs_;
};

TEST_F(TakeStarterTest, AnnouncesNothingBeforeAllRigsAreReady) {
    make_ready(0);
    make_ready(1);
    EXPECT_EQ(update(0s), std::nullopt);
    make_ready(2);
    const auto first = update(1s);
    ASSERT_TRUE(first.has_value());
    EXPECT_GT(grid_.time_of(*first), tai_ + 2s) << "the word has to reach every rig before";
    EXPECT_LE(grid_.time_of(*first), tai_ + 2s + grid_.period() + 1ns);
    EXPECT_EQ(update(10s), first) << "and stays";
}

TEST_F(TakeStarterTest, LimitsTheWaitForAnAbsentRig) {
    make_ready(0);
    make_ready(1);
    rigs_[2].connected = false;
    EXPECT_EQ(update(0s), std::nullopt);
    EXPECT_EQ(update(14s), std::nullopt);
    EXPECT_TRUE(update(15s).has_value());
}

TEST_F(TakeStarterTest, ContinuesARunningTake) {
    rigs_[1].sync.ready = true;
    rigs_[1].sync.first_pulse = 4711;
    EXPECT_EQ(update(0s), 4711u);
}

TEST_F(TakeStarterTest, DoesNotWaitForAPulseThatARigInvents) {
    for (std::size_t rig = 0; rig < rigs_.size(); ++rig) make_ready(rig);
    rigs_[1].sync.first_pulse = grid_.index_at_or_before(tai_ + 61s);
    const auto first = update(0s);
    ASSERT_TRUE(first.has_value());
    EXPECT_LE(grid_.time_of(*first), tai_ + 2s);
}

TEST_F(TakeStarterTest, ReportsRigsThatAreNotReadyOnce) {
    rigs_[0].sync.first_pulse = 4711;
    make_ready(0);
    update(0s);
    EXPECT_TRUE(starter_.laggards(rigs_, monotonic_).empty()) << "the others were not heard yet";
    make_ready(1);
    EXPECT_TRUE(starter_.laggards(rigs_, monotonic_ + 2s).empty());
    EXPECT_EQ(starter_.laggards(rigs_, monotonic_ + 3s), std::vector<std::size_t>{2});
    EXPECT_TRUE(starter_.laggards(rigs_, monotonic_ + 9s).empty());
}

TEST_F(TakeStarterTest, ReportsNoRigBeforeATake) {
    make_ready(0);
    update(0s);
    EXPECT_TRUE(starter_.laggards(rigs_, monotonic_ + 10s).empty());
}

TEST_F(TakeStarterTest, IgnoresDisconnectedRigs) {
    rigs_[1].sync.first_pulse = 4711;
    rigs_[1].connected = false;
    EXPECT_EQ(update(0s), std::nullopt);
}

}  // namespace
}  // namespace vantage
