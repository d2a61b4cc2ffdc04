#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "common/base/error.h"
#include "common/colour/colour_file.h"
#include "common/image/image_file.h"
#include "tests/support/child_program.h"
#include "tests/support/data_folder.h"
#include "tests/support/free_ports.h"
#include "tests/support/full_disk.h"
#include "tests/support/virtual_screen.h"

namespace vantage {
namespace {

constexpr const char* first_progress = " frames, ";

/// Two tiny rigs on the virtual stage and a host; each is a process.
class LiveProcesses : public testing::Test {
  protected:
    LiveProcesses() {
        std::ofstream(file("stage.toml")) << "version = 1\nrate_hz = 5\nlatency_budget_ms = 5000\n"
                                             "[view]\nwidth_px = 128\nheight_px = 72\n"
                                          << stage_entry("left") << stage_entry("right");
    }

    std::string file(const std::string& name) const { return (folder_.path() / name).string(); }
    std::string endpoint(const std::string& rig) const {
        return fmt::format("tcp://127.0.0.1:{}", rig == "left" ? ports_.first : ports_.second);
    }
    std::string stage_entry(const std::string& rig) const {
        return "[[rigs]]\nname = \"" + rig + "\"\nendpoint = \"" + endpoint(rig) + "\"\n";
    }

    void start_rig(const std::string& name, double azimuth_deg) {
        std::ofstream(file(name + ".toml"))
            << "version = 1\nname = \"" << name
            << "\"\n[source]\nrate_hz = 5\nwidth_px = 160\nheight_px = 120\n"
            << "[virtual_rig]\nazimuth_deg = " << azimuth_deg
            << "\n[match]\nmatcher = \"exact\"\ndisparities = 32\n"
            << "[stream]\nbind = \"" << endpoint(name) << "\"\n";
        rigs_.push_back(std::make_unique<ChildProgram>(
            VANTAGE_RIG_PROGRAM, std::vector<std::string>{"run", "--config", file(name + ".toml")},
            folder_.path()));
    }

    std::unique_ptr<ChildProgram> start_host(const std::vector<std::string>& options) {
        std::vector<std::string> arguments{"live", "--stage", file("stage.toml"), "--headless"};
        arguments.insert(arguments.end(), options.begin(), options.end());
        return std::make_unique<ChildProgram>(VANTAGE_PROGRAM, arguments, folder_.path());
    }

    /// Turns the camera by 18 degrees from the first rig's position, in a window of 640x360.
    static void turn_by_mouse_and_quit(const VirtualScreen& screen, ChildProgram& host) {
        // The camera is at the first rig once the stage is known.
        host.wait_for("azimuth -12.0");
        screen.operator_input({"search", "--sync", "--name", "Vantage", "windowfocus"});
        // Show the picture alone, so that it is as wide as the window.
        screen.operator_input({"key", "Tab", "sleep", "1"});
        // Drag a tenth of the picture's width to the right: the stage turns by 18 degrees
        // from the first rig's position.
        screen.operator_input({"mousemove", "320", "120", "mousedown", "1", "mousemove", "384",
                               "120", "mouseup", "1"});
        host.wait_for("azimuth -30.0");
        screen.operator_input({"key", "Escape", "Escape"});
    }

    TemporaryFolder folder_;
    std::pair<int, int> ports_ = two_free_ports();
    std::vector<std::unique_ptr<ChildProgram>> rigs_;
};

TEST_F(LiveProcesses, ShowTheStageAndAccountForEveryFrame) {
    start_rig("left", -12);
    start_rig("right", 12);
    write_colour_image(file("last.png"), ColourImage(1, 1));
    const auto host = start_host({"--frames", "10", "--snapshot", file("last.png"), "--record",
                                  file("flight.mkv"), "--json", "--wait", "60", "--overwrite"});
    ASSERT_EQ(host->wait().status, 0) << host->err() << rigs_[0]->err();
    const nlohmann::json summary = nlohmann::json::parse(host->out());
    EXPECT_GE(summary["pictures"], 10);
    EXPECT_GE(summary["new_pictures"], 1);
    EXPECT_GE(summary["pictures"], summary["new_pictures"].get<int>() +
                                       summary["reprojected_ticks"].get<int>() +
                                       summary["repeated_ticks"].get<int>());
    EXPECT_EQ(summary["film"]["pictures"].get<int>() + summary["film"]["dropped"].get<int>(),
              summary["pictures"])
        << "the film has every tick";
    EXPECT_EQ(summary["frame_sets"]["closed"], summary["frame_sets"]["fused"].get<int>() +
                                                   summary["frame_sets"]["replaced"].get<int>() +
                                                   summary["frame_sets"]["dropped"].get<int>());
    EXPECT_GE(summary["frame_sets"]["fused"], 1);
    ASSERT_EQ(summary["rigs"].size(), 2u);
    for (const nlohmann::json& rig : summary["rigs"]) {
        const auto count = [&](const char* place, const char* what) {
            return rig[place][what].get<std::int64_t>();
        };
        EXPECT_GE(count("host", "fused"), 1) << rig;
        EXPECT_EQ(
            count("host", "in_frame_sets"),
            count("host", "fused") + count("host", "replaced") + count("host", "dropped_at_start"))
            << rig;
        // Frames in no other counter are in a frame set that is still open.
        const std::int64_t open = count("host", "received") - count("host", "in_frame_sets") -
                                  count("host", "late") - count("host", "duplicate") -
                                  count("host", "unsynchronized") - count("host", "out_of_step");
        EXPECT_GE(open, 0) << rig;
        EXPECT_LE(open, 25 + 1) << "the frames of the latency budget: " << rig;
        EXPECT_GE(count("link", "sent"), count("host", "received")) << rig;
        EXPECT_EQ(count("host", "undecodable"), 0) << rig;
        EXPECT_GE(count("rig", "captured"), count("rig", "published")) << rig;
        EXPECT_GT(rig["latency_ms"]["p50"], 0) << rig;
    }
    for (const char* stage : {"capture", "match", "pack", "network", "decode", "prepare", "render"})
        EXPECT_GT(summary["stages_ms"][stage]["count"], 0) << stage;

    const ColourImage picture = read_colour_image(file("last.png"));
    EXPECT_EQ(picture.size(), cv::Size(128, 72));
    cv::Scalar mean, deviation;
    cv::meanStdDev(picture, mean, deviation);
    EXPECT_GT(deviation[0], 15) << "a stage is to be seen";
    EXPECT_TRUE(std::filesystem::exists(file("flight.mkv")));
}

TEST_F(LiveProcesses, ContinueWithoutAFailedFilmAndNameItAtTheEnd) {
    start_rig("left", -12);
    start_rig("right", 12);
    std::unique_ptr<ChildProgram> host;
    {
        const FullDisk disk(16'000);  // the summary fits, the film does not
        host = start_host({"--frames", "100", "--rate", "25", "--record", file("flight.mkv"),
                           "--json", "--wait", "60"});
    }
    EXPECT_EQ(host->wait().status, 1) << host->err();
    const nlohmann::json summary = nlohmann::json::parse(host->out());
    EXPECT_GE(summary["pictures"], 100);
    ASSERT_EQ(summary["outputs"].size(), 1u);
    EXPECT_NE(summary["outputs"][0]["failure"], "");
    const std::string err = host->err();
    const std::string last = err.substr(err.rfind('\n', err.size() - 2) + 1);
    EXPECT_NE(last.find(file("flight.mkv")), std::string::npos) << err;
    EXPECT_NE(last.find("File too large"), std::string::npos) << err;
}

TEST_F(LiveProcesses, SendTheProgrammeToSeveralOutputsThoughOneFails) {
    start_rig("left", -12);
    start_rig("right", 12);
    const auto host =
        start_host({"--frames", "30", "--rate", "30000/1001", "--output", file("flight.mkv"),
                    "--output", "-", "--output", "udp://127.0.0.1:5997", "--output",
                    "v4l2:/dev/no-such-video", "--json", "--wait", "60"});
    EXPECT_EQ(host->wait().status, 1) << "an output has failed";
    const std::string err = host->err();
    const std::size_t begin = err.find("{\"pictures\"");
    ASSERT_NE(begin, std::string::npos) << err;
    const nlohmann::json summary =
        nlohmann::json::parse(err.substr(begin, err.find('\n', begin) - begin));
    EXPECT_DOUBLE_EQ(summary["rate_hz"], 30000.0 / 1001);
    ASSERT_EQ(summary["outputs"].size(), 4u);
    for (const nlohmann::json& output : summary["outputs"]) {
        EXPECT_EQ(output["offered"], summary["pictures"]) << output;
        EXPECT_EQ(output["offered"], output["pictures"].get<int>() + output["dropped"].get<int>() +
                                         output["unheard"].get<int>())
            << output;
    }
    EXPECT_EQ(summary["outputs"][1]["encoder"], "");
    EXPECT_EQ(summary["outputs"][3]["state"], "failed");
    EXPECT_NE(err.find("v4l2:/dev/no-such-video failed"), std::string::npos) << err;
    // Standard output has nothing but frames.
    const std::string out = host->out();
    const std::size_t head = out.find('\n') + 1;
    EXPECT_NE(out.substr(0, head).find("W128 H72 F30000:1001 "), std::string::npos);
    EXPECT_EQ((out.size() - head) % (6 + 128 * 72 * 3 / 2), 0u);
    EXPECT_GE((out.size() - head) / (6 + 128 * 72 * 3 / 2),
              summary["outputs"][1]["pictures"].get<std::size_t>());
}

TEST_F(LiveProcesses, ContinueWithoutAMissingRig) {
    start_rig("left", 0);
    rigs_[0]->wait_for("publishing on");
    const auto host = start_host({"--frames", "2", "--json", "--wait", "4"});
    ASSERT_EQ(host->wait().status, 0) << host->err();
    // Longer than 4 s if the other rig still reported that it started.
    EXPECT_NE(host->err().find(" s: right disconnected"), std::string::npos) << host->err();
    const nlohmann::json summary = nlohmann::json::parse(host->out());
    EXPECT_EQ(summary["frame_sets"]["complete"], 0);
    EXPECT_EQ(summary["rigs"][1]["state"], "disconnected");
    EXPECT_EQ(summary["rigs"][1]["host"]["received"], 0);
}

TEST_F(LiveProcesses, FailIfNoRigSendsAFrame) {
    const auto host = start_host({"--wait", "1", "--snapshot", file("last.png")});
    EXPECT_EQ(host->wait().status, 1);
    EXPECT_NE(host->err().find("no rig sent a frame within 1 s"), std::string::npos) << host->err();
    EXPECT_EQ(host->out(), "");
    EXPECT_FALSE(std::filesystem::exists(file("last.png")));
}

TEST_F(LiveProcesses, ApplyTheStagesColourCorrectionToEveryRig) {
    start_rig("left", -12);
    start_rig("right", 12);
    const auto flown = [&](const std::string& picture) {
        const auto host =
            start_host({"--frames", "3", "--snapshot", file(picture), "--wait", "60"});
        EXPECT_EQ(host->wait().status, 0) << host->err() << rigs_[0]->err();
        return cv::mean(read_colour_image(file(picture)));
    };
    const cv::Scalar plain = flown("plain.png");
    ASSERT_GT(plain[1], 10);
    // No green is left, which an uncorrected picture has as much of as red.
    ColourCorrection only_red_and_blue;
    only_red_and_blue.matrix(1, 1) = 0;
    save_colour(file("left.colour.toml"), only_red_and_blue, {});
    save_colour(file("right.colour.toml"), only_red_and_blue, {});
    std::ofstream(file("stage.toml")) << "version = 1\nrate_hz = 5\nlatency_budget_ms = 5000\n"
                                         "[view]\nwidth_px = 128\nheight_px = 72\n"
                                      << stage_entry("left") << "colour = \"left.colour.toml\"\n"
                                      << stage_entry("right") << "colour = \"right.colour.toml\"\n";
    const cv::Scalar corrected = flown("corrected.png");
    EXPECT_LT(corrected[1], 0.4 * plain[1]);
    EXPECT_GT(corrected[0], 0.6 * plain[0]);
    EXPECT_GT(corrected[2], 0.6 * plain[2]);
}

TEST_F(LiveProcesses, NameTheMissingRigsWhenInterruptedWhileWaiting) {
    const auto host = start_host({"--wait", "600", "--snapshot", file("last.png")});
    host->wait_for("waiting for the first frames of 2 rigs");
    host->send_signal(SIGINT);
    EXPECT_EQ(host->wait().status, 130);
    for (const char* rig : {"left disconnected", "right disconnected"})
        EXPECT_NE(host->err().find(rig), std::string::npos) << host->err();
    EXPECT_EQ(host->out(), "");
    EXPECT_FALSE(std::filesystem::exists(file("last.png")));
}

TEST_F(LiveProcesses, RefuseInvalidOptionsBeforeConnecting) {
    write_colour_image(file("there.png"), ColourImage(1, 1));
    const struct {
        std::vector<std::string> options;
        std::string reason;
    } cases[] = {{{"--snapshot", file("there.png")}, "there.png is there already"},
                 {{"--contact-sheet", file("there.png")}, "--overwrite"},
                 {{"--trace", file("there.png")}, "there.png is there already"},
                 {{"--synth", "hologram"}, "hologram"},
                 {{"--size", "12x80000"}, "12x80000"},
                 {{"--snapshot", "/nowhere/at/all.png"}, "/nowhere/at/all.png"},
                 {{"--record", file("film.avi")}, ".mkv"},
                 {{"--output", "srt://0.0.0.0:9000?mode=listener"}, "whoever calls"},
                 {{"--record", file("a.mkv"), "--output", file("a.mkv")}, "two outputs"},
                 {{"--size", "241x136", "--record", file("odd.mkv")}, "even"},
                 {{"--size", "241x136", "--output", "udp://127.0.0.1:9"}, "241x136"},
                 {{"--size", "240x137", "--output", "srt://127.0.0.1:9"}, "240x137"},
                 {{"--size", "241x137", "--output", "rist://127.0.0.1:9"}, "241x137"},
                 {{"--encoder", "libx265"}, "libx264"},
                 {{"--rate", "30/0"}, "30000/1001"},
                 {{"--contact-sheet", file("sheet.gif")}, ".png"},
                 {{"--path", file("none.toml")}, "none.toml"}};
    for (const auto& c : cases) {
        const auto host = start_host(c.options);
        EXPECT_EQ(host->wait().status, 1) << c.options[0];
        EXPECT_NE(host->err().find(c.reason), std::string::npos) << host->err();
    }
    EXPECT_EQ(read_colour_image(file("there.png")).size(), cv::Size(1, 1));
}

TEST_F(LiveProcesses, FollowTheMouseInAWindowUntilEscape) {
    if (!VirtualScreen::is_there()) GTEST_SKIP() << "SKIPPED: Xvfb or xdotool is not installed";
    const VirtualScreen screen(640, 360);
    start_rig("left", -12);
    start_rig("right", 12);
    const TemporaryFolder host_folder;
    ChildProgram host(VANTAGE_PROGRAM,
                      {"live", "--stage", file("stage.toml"), "--size", "640x360", "--json",
                       "--no-jog", "--snapshot", file("screen.png"), "--seconds", "200"},
                      host_folder.path(), {screen.environment()});
    turn_by_mouse_and_quit(screen, host);
    const ProgramResult result = host.wait();
    ASSERT_EQ(result.status, 0) << result.err;
    const nlohmann::json summary = nlohmann::json::parse(result.out);
    EXPECT_NEAR(summary["camera"]["azimuth_deg"].get<double>(), -12 - 18, 0.1) << result.err;
    EXPECT_NEAR(summary["camera"]["elevation_deg"].get<double>(), 10, 0.1);
    EXPECT_EQ(read_colour_image(file("screen.png")).size(), cv::Size(640, 360));
}

/// The places of every flow in a trace, in the order of time: "stf".
std::map<std::string, std::string> flows_of(nlohmann::json events) {
    std::stable_sort(events.begin(), events.end(), [](const auto& a, const auto& b) {
        return a.value("ts", 0.0) < b.value("ts", 0.0);
    });
    std::map<std::string, std::string> flows;
    for (const nlohmann::json& event : events)
        if (event.contains("id")) flows[event["id"]] += event["ph"].get<std::string>();
    return flows;
}

/// The number of flows of a kind (TraceId) whose places match this pattern.
int flows_like(const nlohmann::json& events, char kind, const char* pattern) {
    int count = 0;
    for (const auto& [id, places] : flows_of(events))
        count += id[2] == kind && std::regex_match(places, std::regex(pattern));
    return count;
}

TEST_F(LiveProcesses, TraceEveryStageFromTheOperatorToTheOutputs) {
    if (!VirtualScreen::is_there()) GTEST_SKIP() << "SKIPPED: Xvfb or xdotool is not installed";
    const VirtualScreen screen(640, 360);
    start_rig("left", -12);
    start_rig("right", 12);
    const TemporaryFolder host_folder;
    ChildProgram host(
        VANTAGE_PROGRAM,
        {"live", "--stage", file("stage.toml"), "--size", "640x360", "--json", "--no-jog",
         "--record", file("film.mkv"), "--trace", file("trace.json"), "--seconds", "200"},
        host_folder.path(), {screen.environment()});
    turn_by_mouse_and_quit(screen, host);
    const ProgramResult result = host.wait();
    ASSERT_EQ(result.status, 0) << result.err;
    const nlohmann::json events =
        nlohmann::json::parse(std::ifstream(file("trace.json")), nullptr, false);
    ASSERT_FALSE(events.is_discarded());
    std::map<std::string, int> spans;
    std::set<std::string> tracks;
    for (const nlohmann::json& event : events) {
        spans[event["name"]] += event["ph"] == "X";
        if (event["name"] == "thread_name") tracks.insert(event["args"]["name"]);
    }
    for (const char* stage :
         {"operator input", "tick", "camera sample", "picture", "render", "fence wait", "readback",
          "hand over", "hand to output", "encode and write", "window events", "desk", "swap",
          "receive", "decode", "frame set", "instant", "take views", "prepare"})
        EXPECT_GT(spans[stage], 0) << stage;
    for (const char* track : {"programme", "picture", "receive", "decode", "instants"})
        EXPECT_EQ(tracks.count(track), 1u) << track;
    EXPECT_EQ(tracks.count("output film " + file("film.mkv")), 1u);
    const nlohmann::json summary = nlohmann::json::parse(result.out);
    EXPECT_GE(spans["hand over"], summary["new_pictures"].get<int>());
    // The way of the input, of the camera's step, of the tick and of the frame sets.
    EXPECT_GT(flows_like(events, '4', "s+t+f"), 0);
    EXPECT_GT(flows_like(events, '2', "st+f"), 0);
    EXPECT_GT(flows_like(events, '3', "st"), 0);
    EXPECT_GT(flows_like(events, '1', "st{2,}f+"), 0);
    EXPECT_GT(flows_like(events, '5', "sf"), 0);
    EXPECT_EQ(result.err.find("lacks"), std::string::npos) << result.err;
}

TEST_F(LiveProcesses, LeaveATraceThatCanBeReadWhenKilled) {
    start_rig("left", -12);
    start_rig("right", 12);
    const auto host = start_host({"--trace", file("trace.json"), "--wait", "60"});
    host->wait_for(first_progress);
    host->send_signal(SIGKILL);
    EXPECT_EQ(host->wait().status, 128 + SIGKILL);
    std::stringstream text;
    text << std::ifstream(file("trace.json")).rdbuf();
    const nlohmann::json events = nlohmann::json::parse(text.str() + "]", nullptr, false);
    ASSERT_FALSE(events.is_discarded());
    EXPECT_GT(events.size(), 50u);
}

/// The signals of the preloaded library.
constexpr int hang = SIGUSR1, reset = SIGUSR2;

class GpuTroubles : public LiveProcesses, public testing::WithParamInterface<int> {};
INSTANTIATE_TEST_SUITE_P(LiveProcesses, GpuTroubles, testing::Values(reset, hang),
                         [](const auto& trouble) {
                             return std::string(trouble.param == hang ? "Hang" : "Reset");
                         });

TEST_P(GpuTroubles, AreSurvivedWithoutLosingATick) {
    start_rig("left", -12);
    start_rig("right", 12);
    // The loader parts its list at spaces, which a checkout's path may have.
    std::filesystem::create_symlink(VANTAGE_GPU_RESET, file("gpu_reset.so"));
    ChildProgram host(VANTAGE_PROGRAM,
                      {"live", "--stage", file("stage.toml"), "--headless", "--rate", "10",
                       "--frames", "120", "--snapshot", file("last.png"), "--json", "--wait", "60"},
                      folder_.path(), {"LD_PRELOAD=" + file("gpu_reset.so")});
    host.wait_for(first_progress);
    host.send_signal(GetParam());
    const ProgramResult result = host.wait();
    ASSERT_EQ(result.status, 0) << result.err;
    const nlohmann::json summary = nlohmann::json::parse(result.out);
    EXPECT_EQ(summary["contexts_lost"], 1) << result.err;
    EXPECT_EQ(result.err.find("it hangs, or its driver") != std::string::npos, GetParam() == hang)
        << result.err;
    EXPECT_LE(summary["missed_ticks"].get<double>(), 1 + 0.02 * summary["pictures"].get<double>())
        << "ticks go on while contexts are made: " << summary["tick_late_ms"];
    EXPECT_GE(summary["new_pictures"], 5);
    // A lost context draws black.
    EXPECT_GT(cv::mean(read_colour_image(file("last.png")))[1], 20);
}

TEST_F(LiveProcesses, FinishTheFilesWhenInterrupted) {
    start_rig("left", -12);
    start_rig("right", 12);
    const auto host = start_host({"--record", file("flight.mkv"), "--json", "--wait", "60"});
    host->wait_for(first_progress);
    host->send_signal(SIGINT);
    EXPECT_EQ(host->wait().status, 130) << host->err();
    EXPECT_GE(nlohmann::json::parse(host->out())["pictures"], 1);
    EXPECT_TRUE(std::filesystem::exists(file("flight.mkv")));
}

}  // namespace
}  // namespace vantage
