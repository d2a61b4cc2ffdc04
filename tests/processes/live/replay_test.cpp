#include <algorithm>
#include <array>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <sstream>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "host_app/replay/clip.h"
#include "tests/processes/live/steered_show.h"
#include "tests/support/child_program.h"
#include "tests/support/data_folder.h"
#include "tests/support/free_ports.h"

namespace vantage {
namespace {

constexpr double rate_hz = 5;

/// A rig on the virtual stage, and a host that is steered over OSC.
class ReplayShow : public testing::Test {
  protected:
    ReplayShow() {
        const std::string endpoint = fmt::format("tcp://127.0.0.1:{}", two_free_ports().first);
        std::ofstream(file("stage.toml"))
            << "version = 1\nrate_hz = " << rate_hz
            << "\nlatency_budget_ms = 5000\n[[rigs]]\nname = \"left\"\nendpoint = \"" << endpoint
            << "\"\n";
        std::ofstream(file("left.toml"))
            << "version = 1\nname = \"left\"\n[source]\nrate_hz = " << rate_hz
            << "\nwidth_px = 160\nheight_px = 120\n[match]\nmatcher = \"exact\"\n"
            << "disparities = 32\n[stream]\nbind = \"" << endpoint << "\"\n";
        rig_ = std::make_unique<ChildProgram>(
            VANTAGE_RIG_PROGRAM, std::vector<std::string>{"run", "--config", file("left.toml")},
            folder_.path());
        show_ = std::make_unique<SteeredShow>(
            std::vector<std::string>{"live", "--stage", file("stage.toml"), "--headless", "--size",
                                     "96x72", "--rate", "25", "--wait", "60", "--seconds", "600",
                                     "--take", file("take.mkv"), "--json"},
            folder_);
    }
    std::string file(const std::string& name) const { return (folder_.path() / name).string(); }
    testing::AssertionResult shows(const std::string& lamp, const std::string& value) const {
        return show_->shows(lamp, value);
    }
    void ask(const std::string& words) const {
        ASSERT_TRUE(show_->send("/vantage/" + words)) << words;
    }
    /// Marks a clip of at least six frames.
    void make_clip(const std::string& clips) const {
        ask("no_marks");
        ASSERT_TRUE(shows("mark_in", "0"));
        ask("mark_in");
        ASSERT_TRUE(shows("mark_in", "1"));
        // The mark may belong to a later tick than the last lamp.
        ASSERT_TRUE(show_->goes_past("pulse", std::stod(show_->lamp("pulse")) + 7));
        ask("mark_out");
        ASSERT_TRUE(shows("mark_out", "1"));
        ask("make_clip");
        ASSERT_TRUE(shows("clips", clips));
    }
    Clip clip(int number) const { return saved_clip(file("stage.clips.toml"), number, rate_hz); }

    /// Checks the camera of every tick in the take, over all clips and the return to live.
    void expect_the_camera_to_have_flown_without_a_jump() const {
        const ProgramResult exported = run_to_end(
            VANTAGE_PROGRAM,
            {"take", "export", file("take.mkv"), "--as", "camera", "-o", file("camera")});
        ASSERT_EQ(exported.status, 0) << exported.err;
        std::ifstream csv(file("camera") + "/camera.csv");
        std::string line;
        std::getline(csv, line);
        std::optional<std::array<double, 4>> last;
        double farthest_m = 0, fastest_m_s = 0;
        std::array<double, 4> first{};
        while (std::getline(csv, line)) {
            // tick, pulse, timecode, time_s, x_m, y_m, z_m, ...
            std::istringstream cells(line);
            std::string cell;
            for (int i = 0; i < 3; ++i) std::getline(cells, cell, ',');
            std::array<double, 4> row{};
            for (double& value : row) {
                std::getline(cells, cell, ',');
                value = std::stod(cell);
            }
            const auto distance_m = [&](const std::array<double, 4>& from) {
                return std::hypot(row[1] - from[1], row[2] - from[2], row[3] - from[3]);
            };
            if (!last) first = row;
            farthest_m = std::max(farthest_m, distance_m(first));
            if (last && row[0] > (*last)[0])
                fastest_m_s = std::max(fastest_m_s, distance_m(*last) / (row[0] - (*last)[0]));
            last = row;
        }
        EXPECT_GT(farthest_m, 0.3) << "a hand has turned it";
        // A jump of this distance in one tick would be more than 15 m/s. The camera flies at 6 m/s,
        // and twice the distance after a tick that a busy computer missed.
        EXPECT_LT(fastest_m_s, 12.5);
    }

    TemporaryFolder folder_;
    std::unique_ptr<ChildProgram> rig_;
    std::unique_ptr<SteeredShow> show_;
};

TEST_F(ReplayShow, IsPlayedByAnOperatorWhileTheStageIsRecorded) {
    ASSERT_TRUE(shows("live", "1")) << show_->show().err();
    ASSERT_TRUE(shows("replay", "live"));
    make_clip("1");
    make_clip("2");
    EXPECT_TRUE(shows("live", "1")) << "marks are set while the programme is live";
    const Clip first = clip(1), second = clip(2);
    ASSERT_GE(first.out, first.in + 5);
    ASSERT_GE(second.in, first.out) << "the instant at which the first ended may begin the second";

    ask("clip i 1");
    ask("cue_clip");
    EXPECT_TRUE(shows("replay", "clip"));
    EXPECT_TRUE(shows("pulse", std::to_string(first.in)));
    EXPECT_TRUE(shows("at_in", "1"));
    EXPECT_TRUE(shows("hold", "1"));
    ask("frame_back");
    EXPECT_TRUE(shows("pulse", std::to_string(first.in - 1))) << "the guard band";
    ask("play_clip");
    EXPECT_TRUE(shows("pulse", std::to_string(first.out - 1))) << "the out frame is excluded";
    EXPECT_TRUE(shows("clip_left", "0"));

    ask("add_entry");
    ask("clip i 2");
    ask("clip_shot i 1");
    ask("add_entry");
    ask("orbit f 8.0");
    ask("clip i 1");
    ask("add_entry");
    ASSERT_TRUE(shows("entries", "3"));
    ask("clip_speed i 30");
    ask("entry i 1");
    ask("play_list");
    EXPECT_TRUE(shows("replay", "list"));
    EXPECT_TRUE(shows("played_entry", "1"));
    // The second and the third entry are swapped while the first plays: 1, 1, 2.
    ask("entry i 2");
    ask("swap i 3");
    EXPECT_EQ(show_->lamp("played_entry"), "1") << "it plays on";
    EXPECT_TRUE(shows("played_entry", "2"));
    EXPECT_EQ(show_->lamp("played_clip"), "1");
    EXPECT_TRUE(shows("played_clip", "2"));
    EXPECT_TRUE(shows("pulse", std::to_string(second.out - 1)));
    EXPECT_TRUE(shows("list_left", "0"));

    ask("last_cue");
    EXPECT_TRUE(shows("pulse", std::to_string(first.in))) << "where the list began";
    EXPECT_TRUE(shows("played_entry", "1"));
    EXPECT_TRUE(shows("hold", "1"));
    EXPECT_TRUE(shows("take", "1")) << "all the while";
    ask("delete_clip");
    EXPECT_TRUE(shows(
        "question", "give the command again to delete clip 1, which is in the play list 2 times"));
    EXPECT_EQ(show_->lamp("clips"), "2");
    ask("live");
    EXPECT_TRUE(shows("replay", "live"));
    EXPECT_TRUE(shows("live", "1"));
    EXPECT_TRUE(shows("played_clip", "0"));
    ask("cue_time s -1");
    EXPECT_TRUE(shows("replay", "past"));
    EXPECT_TRUE(shows("hold", "1"));

    show_->show().send_signal(SIGINT);
    const ProgramResult end = show_->show().wait();
    const nlohmann::json summary = nlohmann::json::parse(end.out);
    EXPECT_EQ(summary["control"][0]["unknown"], 0);
    EXPECT_EQ(summary["control"][0]["malformed"], 0) << summary["control"];
    EXPECT_GT(summary["take"]["frames"], 0);
    const ClipBook book = load_clips(file("stage.clips.toml"), rate_hz);
    ASSERT_EQ(book.list.size(), 3u);
    EXPECT_EQ(book.list[1].clip, 1);
    EXPECT_EQ(book.list[2].clip, 2);
    EXPECT_EQ(book.clips.at(1).speed, 0.3);

    expect_the_camera_to_have_flown_without_a_jump();

    // The clips are marks in time, so the take has them too.
    SteeredShow played({"play", file("take.mkv"), "--clips", file("stage.clips.toml"), "--headless",
                        "--size", "96x72", "--speed", "0", "--seconds", "600"},
                       folder_);
    ASSERT_TRUE(played.shows("clips", "2")) << played.show().err();
    ASSERT_TRUE(played.send("/vantage/clip i 2"));
    ASSERT_TRUE(played.send("/vantage/cue_clip"));
    EXPECT_TRUE(played.shows("pulse", std::to_string(second.in))) << played.lamp("notice");
    played.show().send_signal(SIGINT);
}

}  // namespace
}  // namespace vantage
