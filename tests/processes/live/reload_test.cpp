// A running show follows its changed stage file.
#include <csignal>
#include <fstream>
#include <memory>
#include <regex>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/processes/live/steered_show.h"
#include "tests/support/eventually.h"
#include "tests/support/free_ports.h"
#include "tests/support/http_answer.h"
#include "tests/support/tiny_rig.h"

namespace vantage {
namespace {

class Reload : public testing::Test {
  protected:
    std::string file(const std::string& name) const { return (folder_.path() / name).string(); }
    static std::string endpoint(int port) { return fmt::format("tcp://127.0.0.1:{}", port); }

    std::unique_ptr<ChildProgram> start_rig(const std::string& name, int azimuth_deg, int port) {
        return start_tiny_rig(VANTAGE_RIG_PROGRAM, folder_.path(), name, azimuth_deg,
                              endpoint(port));
    }

    struct Entry {
        std::string rig;
        int port;
    };
    void write_stage(const std::string& head, const std::vector<Entry>& rigs) const {
        std::ofstream stage(file("stage.toml"));
        stage << "version = 1\n" << head;
        for (const Entry& entry : rigs)
            stage << "[[rigs]]\nname = \"" << entry.rig << "\"\nendpoint = \""
                  << endpoint(entry.port) << "\"\n";
        stage << "[view]\nwidth_px = 96\nheight_px = 64\n";
    }

    /// The rig's frames in frame sets, as the metrics say; -1: they do not name the rig.
    int frames_of(const std::string& rig) const {
        const std::string text = http_answer(metrics_port_, "GET", "/metrics");
        const std::regex line("vantage_rig_frame_results_total\\{rig=\"" + rig +
                              "\",place=\"host\",result=\"in_frame_sets\"\\} ([0-9]+)");
        std::smatch found;
        return std::regex_search(text, found, line) ? std::stoi(found[1]) : -1;
    }
    bool goes_on(const std::string& rig) const {
        const int before = frames_of(rig);
        return eventually([&] { return frames_of(rig) > before + 2; });
    }

    TemporaryFolder folder_;
    const std::pair<int, int> ports_ = two_free_ports(), more_ports_ = two_free_ports();
    const int metrics_port_ = more_ports_.second;
};

TEST_F(Reload, ARigJoinsOneLeavesAndABadFileIsRefusedWhileTheShowGoesOn) {
    const Entry left{"left", ports_.first}, right{"right", ports_.second},
        middle{"middle", more_ports_.first};
    const auto left_rig = start_rig("left", -12, left.port),
               right_rig = start_rig("right", 12, right.port);
    write_stage("rate_hz = 5\nlatency_budget_ms = 5000\n", {left, right});
    SteeredShow steered(
        {"live", "--stage", file("stage.toml"), "--headless", "--json", "--wait", "60", "--rate",
         "10", "--seconds", "600", "--metrics", fmt::format("http://:{}", metrics_port_)},
        folder_);
    const ChildProgram& host = steered.show();
    ASSERT_TRUE(eventually([&] { return frames_of("right") > 2; })) << host.err();

    const auto middle_rig = start_rig("middle", 0, middle.port);
    write_stage("rate_hz = 10\nlatency_budget_ms = 4000\n", {right, middle});
    ASSERT_TRUE(steered.send("/vantage/reload_stage"));
    EXPECT_TRUE(steered.shows("stage",
                              "stage file reloaded: added rig middle; removed rig left; another "
                              "latency budget; not applied until the next start: rate_hz"))
        << host.err();
    ASSERT_TRUE(eventually([&] { return frames_of("middle") > 2; })) << host.err();
    EXPECT_NE(host.err().find("rig left is removed from the stage"), std::string::npos);
    EXPECT_EQ(host.err().find("rig left is gone"), std::string::npos);
    const int frames_of_left = frames_of("left");
    ASSERT_TRUE(goes_on("right"));
    EXPECT_EQ(frames_of("left"), frames_of_left);

    write_stage("rate_hz = -1\n", {left});
    ASSERT_TRUE(steered.send("/vantage/reload_stage"));
    ASSERT_TRUE(eventually([&] {
        return steered.lamp("stage").find("the stage stays as it was") != std::string::npos;
    })) << steered.lamp("stage");
    EXPECT_NE(steered.lamp("stage").find("'rate_hz' is -1, but must be"), std::string::npos)
        << steered.lamp("stage");
    ASSERT_TRUE(goes_on("right") && goes_on("middle"));

    write_stage("rate_hz = 5\nlatency_budget_ms = 4000\n", {left, right, middle});
    ASSERT_TRUE(steered.send("/vantage/reload_stage"));
    EXPECT_TRUE(steered.shows("stage", "stage file reloaded: added rig left"));
    ASSERT_TRUE(eventually([&] { return frames_of("left") > frames_of_left + 2; })) << host.err();

    write_stage("rate_hz = 5\nlatency_budget_ms = 4000\n", {right, middle});
    ASSERT_TRUE(steered.send("/vantage/reload_stage"));
    EXPECT_TRUE(steered.shows("stage", "stage file reloaded: removed rig left"));
    ASSERT_TRUE(goes_on("middle"));
    host.send_signal(SIGINT);
    const ProgramResult result = steered.show().wait();
    EXPECT_EQ(result.status, 130) << result.err;
    const nlohmann::json summary = nlohmann::json::parse(result.out);
    EXPECT_EQ(summary["stage_reloads"]["done"], 3);
    EXPECT_EQ(summary["stage_reloads"]["refused"], 1);
    EXPECT_LE(summary["missed_ticks"].get<double>(), 1 + 0.02 * summary["pictures"].get<double>())
        << summary["tick_late_ms"];
    EXPECT_EQ(summary["faults"], 0) << result.err;
    ASSERT_EQ(summary["rigs"].size(), 3u);
    const nlohmann::json stays = summary["rigs"][0], joins = summary["rigs"][1],
                         leaves = summary["rigs"][2];
    EXPECT_EQ(stays["name"], "right");
    EXPECT_EQ(stays["state"], "connected");
    EXPECT_EQ(stays["outages"]["count"], 0);
    EXPECT_EQ(stays["link"]["lost"], 0);
    EXPECT_EQ(stays["link"]["send_dropped"], 0);
    EXPECT_LE(stays["host"]["late"], 1) << "its first frame may come before the other rig's";
    EXPECT_EQ(joins["name"], "middle");
    EXPECT_EQ(joins["state"], "connected");
    EXPECT_EQ(joins["outages"]["count"], 0);
    EXPECT_EQ(leaves["name"], "left");
    EXPECT_EQ(leaves["state"], "removed");
    EXPECT_EQ(leaves["outages"]["count"], 0) << "removed is not gone";
    EXPECT_EQ(leaves["outages"]["restarts"], 0);
}

}  // namespace
}  // namespace vantage
