// What a show does while one rig's network loses packets or is down.
#include <csignal>
#include <regex>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "tests/faults/shows/two_rig_show.h"
#include "tests/support/http_answer.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;

class RoadFaults : public TwoRigShow {
  protected:
    /// Nobody else listens where the host is.
    static constexpr int metrics_port = 9464;
    /// Two seconds.
    static constexpr int sets_to_recover = 10;

    struct Sets {
        int far = 0, near = 0;
    };
    /// The sets that each rig has been in, both at one moment: the host's next word of them.
    Sets next_sets() {
        std::string text;
        EXPECT_TRUE(comes([&] {
            text = http_answer(metrics_port, "GET", "/metrics");
            text.erase(0, text.find("\r\n\r\n"));
            return !text.empty() && text != last_word_;
        }));
        last_word_ = text;
        const auto count = [&](const std::string& rig) {
            const std::regex line("vantage_rig_frames_total\\{rig=\"" + rig +
                                  "\",place=\"host\",result=\"in_sets\"\\} ([0-9]+)");
            std::smatch found;
            return std::regex_search(text, found, line) ? std::stoi(found[1]) : 0;
        };
        return {count("far"), count("near")};
    }

    /// Sets that lacked the far rig before it was in every one again. Counted by the rig beside, so
    /// that a slow computer has as much time as it takes to film them.
    int sets_until_back() {
        (void)next_sets();  // of whenever the host said it
        const Sets at_first = next_sets();
        road_->impair({});
        Sets before = at_first;
        while (true) {
            const Sets now = next_sets();
            const int missed = now.near - at_first.near - (now.far - at_first.far);
            const bool is_back =
                now.near > before.near && now.far - before.far >= now.near - before.near;
            if (is_back || missed > 10 * sets_to_recover || HasFailure()) return missed;
            before = now;
        }
    }

    /// For a while, and until the trouble has met packets of either way.
    void impair(const RoadTrouble& trouble) {
        const auto met = [&] {
            const ImpairedRoad::Counts counts = road_->counts();
            return counts.lost + counts.duplicated + counts.corrupted + counts.late;
        };
        const std::uint64_t before = met();
        road_->impair(trouble);
        usleep(1'500'000);
        ASSERT_TRUE(comes([&] { return met() > before + 1; }));
    }

  private:
    std::string last_word_;
};

TEST_F(RoadFaults, HoldTheTicksAndAreOverOnceTheRoadIsWhole) {
    start_host({"--seconds", "600", "--metrics", fmt::format("http://:{}", metrics_port)});
    wait_for(*host_, " pictures, ");
    ASSERT_TRUE(comes([&] { return far_is("connected"); })) << host_->err();

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
        EXPECT_LE(sets_until_back(), sets_to_recover) << name << "\n" << host_->err();
    }
    EXPECT_EQ(count_of("rig far is gone"), 0u) << host_->err();

    road_->impair({.is_down = true});
    usleep(10'000'000);
    ASSERT_TRUE(far_is("gone")) << host_->err();
    EXPECT_LE(sets_until_back(), sets_to_recover) << host_->err();
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
