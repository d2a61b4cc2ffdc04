// A show whose far rig sends by datagrams: over a lossy road, and where they are blocked.
#include <csignal>
#include <string>

#include <nlohmann/json.hpp>

#include "tests/faults/shows/two_rig_show.h"
#include "tests/support/eventually.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;

class DatagramShow : public TwoRigShow {
  protected:
    std::string far_road() const override { return "srt"; }
};

TEST_F(DatagramShow, PlaysOnOverTcpWhileDatagramsAreBlocked) {
    const RoadTrouble lossy{.lose_every = 14, .delay = 10ms};
    road_->impair(lossy);
    start_host({"--seconds", "600"});
    host_->wait_for("rig far: its frames come over SRT");
    far_->wait_for("over SRT");
    wait_for_progress();
    wait_for_progress();

    RoadTrouble blocked;
    blocked.is_down = blocked.only_udp = true;
    road_->impair(blocked);
    host_->wait_for("rig far: its frames come over TCP because");
    far_->wait_for("over TCP because");
    EXPECT_LE(sets_until_far_is_back([&] { road_->impair(lossy); }), sets_to_recover)
        << host_->err();
    ASSERT_TRUE(eventually([&] { return count_of("rig far: its frames come over SRT") == 2; }))
        << host_->err();
    wait_for_progress();

    host_->send_signal(SIGINT);
    const ProgramResult result = host_->wait();
    const nlohmann::json summary = nlohmann::json::parse(result.out);
    const nlohmann::json far = summary["rigs"][0], near = summary["rigs"][1];
    EXPECT_EQ(far["road"], "srt");
    EXPECT_EQ(near["road"], "tcp");
    EXPECT_EQ(far["outages"]["count"], 0) << result.err;
    expect_balanced(far);
    expect_balanced(near);
    EXPECT_EQ(near["link"]["lost"], 0) << "the rig beside has noticed nothing";
}

}  // namespace
}  // namespace vantage
