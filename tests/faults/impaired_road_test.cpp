#include "tests/faults/impaired_road.h"

#include <cstring>
#include <memory>
#include <thread>
#include <vector>

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>

namespace vantage {
namespace {

/// Datagrams, so that no other hand mends what the road does.
class ImpairedRoadTest : public testing::Test {
  protected:
    void SetUp() override {
        if (const std::string reason = ImpairedRoad::reason_against(); !reason.empty())
            GTEST_SKIP() << "SKIPPED: " << reason;
        road_ = std::make_unique<ImpairedRoad>();
        sockaddr_in place{};
        place.sin_family = AF_INET;
        place.sin_port = htons(4000);
        ::inet_pton(AF_INET, ImpairedRoad::rig_address, &place.sin_addr);
        road_->at_the_rigs([&] {
            rig_ = UniqueFd(::socket(AF_INET, SOCK_DGRAM, 0));
            ASSERT_EQ(::bind(rig_.get(), reinterpret_cast<sockaddr*>(&place), sizeof place), 0);
        });
        host_ = UniqueFd(::socket(AF_INET, SOCK_DGRAM, 0));
        ASSERT_EQ(::connect(host_.get(), reinterpret_cast<sockaddr*>(&place), sizeof place), 0);
    }
    /// One after the other, each once the road has seen the one before.
    void send(unsigned count) {
        for (unsigned i = 1; i <= count; ++i) {
            const std::uint64_t before = road_->counts().came;
            ASSERT_EQ(::send(host_.get(), &i, sizeof i, 0), static_cast<ssize_t>(sizeof i));
            while (road_->counts().came == before) std::this_thread::yield();
        }
    }
    /// Of so many datagrams; a minute's patience.
    std::vector<unsigned> hear(std::size_t count) {
        std::vector<unsigned> all;
        pollfd item{rig_.get(), POLLIN, 0};
        while (all.size() < count && ::poll(&item, 1, 60'000) == 1) {
            unsigned number = 0;
            if (::recv(rig_.get(), &number, sizeof number, 0) == sizeof number)
                all.push_back(number);
        }
        return all;
    }

    std::unique_ptr<ImpairedRoad> road_;
    UniqueFd rig_, host_;
};

TEST_F(ImpairedRoadTest, CarriesAllWithoutTrouble) {
    send(4);
    EXPECT_EQ(hear(4), (std::vector<unsigned>{1, 2, 3, 4}));
}

TEST_F(ImpairedRoadTest, LosesEveryNthAndDamagedOnesAreNotTaken) {
    road_->impair({.lose_every = 3});
    send(6);
    EXPECT_EQ(hear(4), (std::vector<unsigned>{1, 2, 4, 5}));
    road_->impair({.corrupt_every = 2});  // of 7 to 9
    send(3);
    EXPECT_EQ(hear(2), (std::vector<unsigned>{1, 3})) << "the kernel knows by the check sum";
    EXPECT_EQ(road_->counts().lost, 2u);
    EXPECT_EQ(road_->counts().corrupted, 1u);
}

TEST_F(ImpairedRoadTest, LosesInARowByOneWayAndBySize) {
    road_->impair({.lose_every = 4, .lose_run = 2});  // the fourth and what follows it
    send(6);
    EXPECT_EQ(hear(4), (std::vector<unsigned>{1, 2, 3, 6}));
    road_->impair({}, {.is_down = true});
    send(2);
    EXPECT_EQ(hear(2), (std::vector<unsigned>{1, 2})) << "only the other way is down";
    // A datagram of 4 bytes has 32 with its heads.
    road_->impair({.lose_over_bytes = 32});
    send(1);
    EXPECT_EQ(hear(1).size(), 1u);
    road_->impair({.lose_over_bytes = 31});
    send(1);
    EXPECT_EQ(road_->counts().lost, 2u + 1);
}

TEST_F(ImpairedRoadTest, DuplicatesAndHoldsBackEveryNth) {
    using namespace std::chrono_literals;
    road_->impair({.duplicate_every = 2});
    send(2);
    EXPECT_EQ(hear(3), (std::vector<unsigned>{1, 2, 2}));
    road_->impair({.late_every = 3, .late_by = 5s});  // the third of all is the first of these
    send(2);
    EXPECT_EQ(hear(2), (std::vector<unsigned>{2, 1}));
}

TEST_F(ImpairedRoadTest, TakesItsTimeAndIsDown) {
    using namespace std::chrono_literals;
    road_->impair({.delay = 50ms});
    const auto start = std::chrono::steady_clock::now();
    send(1);
    EXPECT_EQ(hear(1).size(), 1u);
    EXPECT_GE(std::chrono::steady_clock::now() - start, 50ms);
    road_->impair({.is_down = true});
    send(3);
    road_->impair({});
    send(1);
    EXPECT_EQ(hear(1), (std::vector<unsigned>{1})) << "nothing of before";
    EXPECT_EQ(road_->counts().lost, 3u);
}

}  // namespace
}  // namespace vantage
