// What a show does while one rig's network loses packets or is down.
#include <csignal>
#include <string>
#include <utility>

#include <nlohmann/json.hpp>
#include <unistd.h>

#include "tests/faults/shows/two_rig_show.h"
#include "tests/support/eventually.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;

class RoadFaults : public TwoRigShow {
  protected:
    /// For a while, and until the trouble has met packets of either way.
    void impair(const RoadTrouble& trouble) {
        const auto met = [&] {
            const ImpairedRoad::Counts counts = road_->counts();
            return counts.lost + counts.duplicated + counts.corrupted + counts.late;
        };
        const std::uint64_t before = met();
        road_->impair(trouble);
        usleep(1'500'000);
        ASSERT_TRUE(eventually([&] { return met() > before + 1; }));
    }
};

TEST_F(RoadFaults, HoldTheTicksAndAreOverOnceTheRoadIsWhole) {
    start_host({"--seconds", "600"});
    host_->wait_for(" frames, ");
    ASSERT_TRUE(eventually([&] { return far_is("connected"); })) << host_->err();

    const auto mend_road = [&] { road_->impair({}); };
    const std::pair<const char*, RoadTrouble> troubles[] = {
        {"1 % lost", {.lose_every = 100}},
        {"3 % lost", {.lose_every = 33}},
        {"7 % lost", {.lose_every = 14}},
        {"10 % lost", {.lose_every = 10}},
        {"3 % lost, 20 ms there and back", {.lose_every = 33, .delay = 10ms}},
        {"doubled", {.duplicate_every = 3}},
        {"in another order", {.late_every = 5, .late_by = 40ms}},
        {"damaged", {.corrupt_every = 33}},
    };
    for (const auto& [name, trouble] : troubles) {
        impair(trouble);
        EXPECT_LE(sets_until_far_is_back(mend_road), sets_to_recover) << name << "\n"
                                                                      << host_->err();
    }
    EXPECT_EQ(count_of("rig far is gone"), 0u) << host_->err();

    road_->impair({.is_down = true});
    usleep(10'000'000);
    ASSERT_TRUE(far_is("gone")) << host_->err();
    EXPECT_LE(sets_until_far_is_back(mend_road), sets_to_recover) << host_->err();
    EXPECT_TRUE(far_is("connected")) << host_->err();

    host_->send_signal(SIGINT);
    const ProgramResult result = host_->wait();
    const nlohmann::json summary = nlohmann::json::parse(result.out);
    expect_ticks_held(summary);
    const nlohmann::json far = summary["rigs"][0], near = summary["rigs"][1];
    EXPECT_EQ(far["outages"]["count"], 1) << result.err;
    EXPECT_EQ(far["outages"]["restarts"], 0);
    EXPECT_EQ(near["outages"]["count"], 0);
    EXPECT_EQ(near["link"]["lost"], 0) << "the rig beside has noticed nothing";
    EXPECT_EQ(near["link"]["send_dropped"], 0);
    expect_balanced(far);
    expect_balanced(near);
    EXPECT_EQ(summary["signal"], "live");
}

}  // namespace
}  // namespace vantage
