#include <csignal>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <numbers>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>
#include <unistd.h>

#include "common/base/files/atomic_file.h"
#include "common/base/time/time.h"
#include "common/base/time/timecode.h"
#include "common/image/image_file.h"
#include "host_app/replay/clip.h"
#include "tests/processes/live/attended.h"
#include "tests/processes/live/camera_on_air.h"
#include "tests/processes/live/steered_show.h"
#include "tests/support/eventually.h"
#include "tests/support/free_ports.h"

namespace vantage {
namespace {

constexpr double show_rate_hz = 5, tick_rate_hz = 25;

/// A whole show with all its controllers, each over a loopback socket: an operator over OSC, a
/// panel over RossTalk, a mixer over TSL UMD, a tracked camera over FreeD, and a graphics computer
/// that receives the camera of every tick.
class WholeShow : public testing::Test {
  protected:
    std::string file(const std::string& name) const { return (folder_.path() / name).string(); }

    /// Pairs a rig and a host, which makes them a stage.
    void set_up_the_stage() {
        const auto [stream, pairing] = two_free_ports();
        std::filesystem::create_directories(file("left"));
        std::ofstream(file("left/rig.toml"))
            << "version = 1\nname = \"left\"\n[source]\nrate_hz = " << show_rate_hz
            << "\nwidth_px = 160\nheight_px = 120\n[match]\nmatcher = \"exact\"\n"
            << "disparities = 32\n[stream]\nbind = \"tcp://127.0.0.1:" << stream << "\"\n";
        Attended rig(VANTAGE_RIG_PROGRAM,
                     fmt::format("pair --json --config '{}' --bind tcp://127.0.0.1:{}",
                                 file("left/rig.toml"), pairing),
                     folder_.path(), "pair");
        rig.wait_for("open");
        Attended host(VANTAGE_PROGRAM,
                      fmt::format("setup --json --stage '{}' --rig 127.0.0.1:{} --wait 60",
                                  file("stage.toml"), pairing),
                      folder_.path(), "setup");
        compare_codes(host, rig, 0);
        ASSERT_EQ(rig.end().status, 0);
        rig_ = std::make_unique<ChildProgram>(
            VANTAGE_RIG_PROGRAM, std::vector<std::string>{"run", "--config", file("left/rig.toml")},
            folder_.path() / "left");
        const ProgramResult result = host.end();
        ASSERT_EQ(result.status, 0) << result.err;
        ASSERT_EQ(event_of(result.out, "checked")["ready"], true) << result.out;
        // A busy computer may be late.
        std::string stage = read_text_file(file("stage.toml"), 1 << 16);
        const std::size_t first = stage.find("version = 1\n");
        ASSERT_NE(first, std::string::npos) << stage;
        stage.insert(first, "latency_budget_ms = 5000\n");
        write_text_atomically(file("stage.toml"), stage);
    }
    void begin() {
        show_ = std::make_unique<SteeredShow>(
            std::vector<std::string>{"live",
                                     "--stage",
                                     file("stage.toml"),
                                     "--headless",
                                     "--size",
                                     "96x72",
                                     "--rate",
                                     fmt::format("{}", tick_rate_hz),
                                     "--wait",
                                     "60",
                                     "--seconds",
                                     "600",
                                     "--free-flight",
                                     "--take",
                                     file("take.mkv"),
                                     "--output",
                                     file("film.mkv"),
                                     "--output",
                                     fmt::format("freed://127.0.0.1:{}", camera_port_),
                                     "--control",
                                     fmt::format("rosstalk://127.0.0.1:{}", panel_port_),
                                     "--control",
                                     fmt::format("tsl://127.0.0.1:{}?address=5", mixer_port_),
                                     "--control",
                                     fmt::format("freed://127.0.0.1:{}", tracker_port_),
                                     "--snapshot",
                                     file("last.png"),
                                     "--json"},
            folder_);
    }
    testing::AssertionResult shows(const std::string& lamp, const std::string& value) const {
        return show_->shows(lamp, value);
    }
    void ask(const std::string& words) const {
        ASSERT_TRUE(show_->send("/vantage/" + words)) << words;
    }
    /// Sends a command such as "GPI 3" over RossTalk.
    void press(const std::string& line) const {
        const std::string said =
            fmt::format("printf '{}\\r\\n' >/dev/tcp/127.0.0.1/{}", line, panel_port_);
        ASSERT_EQ(run_to_end("/bin/bash", {"-c", said}).status, 0) << line;
    }
    /// Sends the mixer's tally in TSL UMD 3.1.
    void tally(int lamps) const {
        std::string message(18, ' ');
        message[0] = static_cast<char>(0x80 + 5);
        message[1] = static_cast<char>(lamps);
        send(std::as_bytes(std::span(message)), mixer_port_);
    }
    void track(const CameraState& camera) const {
        send(encode_freed(freed_camera(camera, 1)), tracker_port_);
    }
    /// Checks that the time code belongs to the pulse that is shown.
    void expect_time_code_of(std::uint64_t pulse) const {
        const TimecodeClock clock(show_rate_hz);
        std::string told;
        EXPECT_TRUE(eventually([&] {
            told = show_->lamp("timecode");
            // The computer's clock may or may not know TAI.
            return told == clock.of_pulse(pulse, 0) || told == clock.of_pulse(pulse, 37);
        })) << told
            << " is not the time code of pulse " << pulse;
    }
    /// Waits until the value has been stable for longer than the lamps' period.
    std::uint64_t settled_pulse() const {
        std::string told = show_->lamp("pulse");
        for (int tries = 0, stood = 0; tries < 600 && stood < 30; ++tries, usleep(100'000)) {
            const std::string now = show_->lamp("pulse");
            stood = now == told ? stood + 1 : 0;
            told = now;
        }
        return std::stoull(told);
    }

    /// Notes the present state; its picture is checked when the film has ended.
    void stop_for_a_picture(const std::string& name) {
        usleep(1'000'000);
        stops_[name] = MonotonicClock::now();
        usleep(1'000'000);
    }
    /// Reads the frame of a noted state from the film, which ended at `end` with this many ticks.
    cv::Mat picture_at(const std::string& name, MonotonicTime end, int ticks) const {
        const std::chrono::duration<double> left = end - stops_.at(name);
        const std::string picture = file(name + ".png");
        const ProgramResult result = run_to_end(
            "/usr/bin/ffmpeg",
            {"-v", "error", "-ss", fmt::format("{:.3f}", ticks / tick_rate_hz - left.count()), "-i",
             file("film.mkv"), "-frames:v", "1", picture});
        EXPECT_EQ(result.status, 0) << name << ": " << result.err;
        return read_colour_image(picture);
    }
    /// Checks the programme's pictures at the noted states.
    void expect_pictures(MonotonicTime end, int ticks) const {
        std::map<std::string, cv::Mat> pictures;
        for (const auto& [name, time] : stops_) {
            pictures[name] = picture_at(name, end, ticks);
            ASSERT_FALSE(pictures[name].empty());
            EXPECT_GT(spread(pictures[name]), 20) << name << " shows something";
        }
        const double of_another_view = difference(pictures["frozen"], pictures["orbited"]);
        EXPECT_GT(of_another_view, 8);
        // A moment that is held is rendered better and better, on a busy computer for seconds.
        EXPECT_LT(difference(pictures["frozen"], pictures["frozen still"]), 0.5 * of_another_view);
        EXPECT_LT(difference(pictures["clip"], pictures["list"]), 8)
            << "its last moment, from where the camera stood";
    }
    static double difference(const cv::Mat& a, const cv::Mat& b) {
        return cv::norm(a, b, cv::NORM_L1) / static_cast<double>(a.total() * a.channels());
    }
    static double spread(const cv::Mat& picture) {
        cv::Scalar mean, deviation;
        cv::meanStdDev(picture, mean, deviation);
        return deviation[0] + deviation[1] + deviation[2];
    }

    TemporaryFolder folder_;
    const int camera_port_ = two_free_ports().first;
    const int panel_port_ = two_free_ports().first;
    const int mixer_port_ = two_free_ports().first;
    const int tracker_port_ = two_free_ports().first;
    CameraOnAir on_air_{camera_port_};
    std::unique_ptr<ChildProgram> rig_;
    std::unique_ptr<SteeredShow> show_;
    std::map<std::string, MonotonicTime> stops_;

  private:
    static void send(std::span<const std::byte> bytes, int port) {
        const SocketAddress to = resolve({"127.0.0.1", port, true}, "the test");
        ASSERT_TRUE(UdpSocket::sending(to).send(bytes, to));
    }
};

TEST_F(WholeShow, IsPlayedFromSetupToExport) {
    ASSERT_NO_FATAL_FAILURE(set_up_the_stage());
    begin();
    ASSERT_TRUE(shows("live", "1")) << show_->show().err();
    ASSERT_TRUE(shows("take", "1"));
    EXPECT_TRUE(shows("film", "1"));

    // The panel marks a clip while the programme is live.
    tally(1);
    EXPECT_TRUE(shows("programme", "1"));
    press("GPI 3");
    ASSERT_TRUE(shows("mark_in", "1"));
    ASSERT_TRUE(show_->goes_past("pulse", std::stod(show_->lamp("pulse")) + 5));
    press("GPI 4");
    ASSERT_TRUE(shows("mark_out", "1"));
    press("GPI 5");
    ASSERT_TRUE(shows("clips", "1"));
    EXPECT_TRUE(shows("live", "1"));
    const Clip marked = saved_clip(file("stage.clips.toml"), 1, show_rate_hz);
    ASSERT_GE(marked.out, marked.in + 5);

    // The instant is frozen, and the camera orbits it.
    tally(2);
    EXPECT_TRUE(shows("preview", "1"));
    EXPECT_TRUE(shows("programme", "0"));
    press("GPI 2");
    ASSERT_TRUE(shows("hold", "1"));
    const std::uint64_t frozen = settled_pulse();
    expect_time_code_of(frozen);
    stop_for_a_picture("frozen");
    stop_for_a_picture("frozen still");
    const Pose before = on_air_.newest();
    ask("orbit f 20.0");
    Pose around = on_air_.newest();
    for (int ticks = 0; ticks < 1500 && way_m(around, before) < 0.3; ++ticks)
        around = on_air_.next();
    EXPECT_GE(way_m(around, before), 0.3) << "twenty degrees";
    EXPECT_EQ(settled_pulse(), frozen) << "and the moment stands";
    stop_for_a_picture("orbited");

    // A tracked camera takes over, and operator input takes the camera back.
    CameraState tracked;
    tracked.world_from_camera = before;
    tracked.world_from_camera.translation() += Eigen::Vector3d(0.4, 0.2, 0);
    tracked.field_of_view_rad = 0.8;
    ask("tracking");
    Pose flown = around;
    for (int i = 0; i < 3000 && way_m(flown, tracked.world_from_camera) > 1e-3; ++i) {
        track(tracked);
        flown = on_air_.newest();
    }
    EXPECT_LE(way_m(flown, tracked.world_from_camera), 1e-3);
    EXPECT_TRUE(shows("tracking", "1"));
    ask("orbit f 3.0");
    EXPECT_TRUE(shows("tracking", "0"));

    // The clip plays in slow motion while the stage is still recorded.
    ask("clip_speed i 40");
    press("GPI 7");
    EXPECT_TRUE(shows("replay", "clip"));
    EXPECT_TRUE(shows("speed", "0.4"));
    EXPECT_TRUE(shows("clip_left", "0"));
    EXPECT_TRUE(shows("pulse", std::to_string(marked.out - 1))) << "the out frame is excluded";
    expect_time_code_of(marked.out - 1);
    stop_for_a_picture("clip");
    EXPECT_TRUE(shows("take", "1"));
    // The list has the clip twice, the second time at normal speed.
    ask("add_entry");
    ask("add_entry");
    ASSERT_TRUE(shows("entries", "2"));
    ask("entry_speed i 100");
    ask("entry i 1");
    press("GPI 9");
    EXPECT_TRUE(shows("replay", "list"));
    EXPECT_TRUE(shows("played_entry", "2"));
    EXPECT_TRUE(shows("list_left", "0"));
    EXPECT_TRUE(shows("pulse", std::to_string(marked.out - 1)));
    stop_for_a_picture("list");

    // Return to live.
    const Pose standing = on_air_.newest();
    press("GPI 1");
    ASSERT_TRUE(shows("live", "1"));
    EXPECT_LT(way_m(on_air_.newest(), standing), 1e-3);
    ASSERT_TRUE(show_->goes_past("pulse", static_cast<double>(frozen)));
    tally(0);
    EXPECT_TRUE(shows("preview", "0"));

    const MonotonicTime ended = MonotonicClock::now();
    show_->show().send_signal(SIGINT);
    const ProgramResult end = show_->show().wait();
    const nlohmann::json summary = nlohmann::json::parse(end.out, nullptr, false);
    ASSERT_TRUE(summary.is_object()) << end.out << end.err;
    EXPECT_EQ(end.err.find("a GPU object ended"), std::string::npos) << end.err;
    for (const nlohmann::json& port : summary["control"]) {
        EXPECT_EQ(port["malformed"], 0) << port;
        EXPECT_EQ(port["unknown"], 0) << port;
        EXPECT_GT(port["obeyed"], 0) << port;
    }
    EXPECT_GT(summary["input_to_picture_ms"]["count"], 0);
    const nlohmann::json& film = summary["outputs"][0];
    EXPECT_EQ(film["pictures"].get<int>() + film["dropped"].get<int>(),
              summary["pictures"].get<int>())
        << "every tick is a picture of the film, or counted: " << film;
    expect_pictures(ended, summary["pictures"].get<int>());
    EXPECT_GT(spread(read_colour_image(file("last.png"))), 20) << "a picture of something";

    // The take is complete, and its camera is exported for other programs.
    EXPECT_EQ(run_to_end(VANTAGE_PROGRAM, {"take", "info", file("take.mkv")}).status, 0);
    const ProgramResult exported =
        run_to_end(VANTAGE_PROGRAM,
                   {"take", "export", file("take.mkv"), "--as", "camera", "-o", file("camera")});
    EXPECT_EQ(exported.status, 0) << exported.err;
    EXPECT_TRUE(std::filesystem::exists(file("camera/camera.csv")));
}

}  // namespace
}  // namespace vantage
