#include <chrono>
#include <csignal>
#include <fstream>
#include <thread>

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/socket.h>

#include "common/base/error.h"
#include "common/base/files/unique_fd.h"
#include "common/config/calibration_file.h"
#include "common/image/image_file.h"
#include "tests/support/child_program.h"
#include "tests/support/data_folder.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;

const std::string small_stage = R"(
version = 1
name = "test"
[source]
kind = "virtual"
rate_hz = 10
width_px = 61
height_px = 47
[match]
disparities = 16
[stream]
bind = "tcp://127.0.0.1:*"
)";

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    if (at == std::string::npos) fail("the text has no '{}'", from);
    return text.replace(at, from.size(), to);
}

class RunCommandTest : public testing::Test {
  protected:
    std::filesystem::path at(const std::string& name) const { return folder_.path() / name; }
    std::string write_config(const std::string& text) const {
        std::ofstream(at("rig.toml")) << text;
        return at("rig.toml").string();
    }
    ProgramResult run(const std::string& config, std::vector<std::string> more = {},
                      const std::vector<std::string>& environment = {}) const {
        more.insert(more.begin(), {"run", "--config", write_config(config)});
        return run_to_end(VANTAGE_RIG, more, environment);
    }
    /// What a run with this configuration says when it refuses; checks that it says one sentence.
    std::string refusal(const std::string& config,
                        const std::vector<std::string>& environment = {}) const {
        const ProgramResult result = run(config, {"--frames", "1"}, environment);
        EXPECT_EQ(result.status, 1) << result.err;
        EXPECT_EQ(result.out, "");
        EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
        EXPECT_TRUE(result.err.starts_with("vantage-rig: error: ")) << result.err;
        return result.err;
    }
    void expect_refusal(const std::string& config, const std::string& words) const {
        const std::string sentence = refusal(config);
        EXPECT_NE(sentence.find(words), std::string::npos) << sentence;
    }
    void write_picture(const std::string& name, cv::Size size) const {
        ColourImage picture(size);
        cv::randu(picture, 0, 255);
        write_colour_image(at(name), picture);
    }

    TemporaryFolder folder_;
};

/// Every captured frame is in one place.
void expect_stats_to_balance(const nlohmann::json& summary) {
    EXPECT_EQ(summary.at("captured").get<int>(),
              summary.at("published").get<int>() + summary.at("late").get<int>())
        << summary;
}

TEST_F(RunCommandTest, PublishesAsManyFramesAsAsked) {
    const ProgramResult result = run(small_stage, {"--frames", "3", "--json"});
    ASSERT_EQ(result.status, 0) << result.err;
    const nlohmann::json summary = nlohmann::json::parse(result.out);
    EXPECT_EQ(summary.at("rig"), "test");
    EXPECT_EQ(summary.at("published"), 3);
    EXPECT_GT(summary.at("match_ms").at("p50").get<double>(), 0);
    expect_stats_to_balance(summary);
    for (const char* line : {"EGL", "GPU:", "matcher", "publishing on tcp://127.0.0.1:"})
        EXPECT_NE(result.err.find(line), std::string::npos) << line;
}

TEST_F(RunCommandTest, EndsInOrderWhenAskedTo) {
    for (const int signal : {SIGTERM, SIGINT}) {
        ChildProgram rig(VANTAGE_RIG, {"run", "--config", write_config(small_stage), "--json"},
                         folder_.path());
        rig.wait_for("publishing on");
        std::this_thread::sleep_for(300ms);
        rig.send_signal(signal);
        const ProgramResult result = rig.wait();
        ASSERT_EQ(result.status, signal == SIGINT ? 130 : 0) << result.err;
        expect_stats_to_balance(nlohmann::json::parse(result.out));
    }
}

TEST_F(RunCommandTest, GoesOnWhenItsClockIsSetByHours) {
    // A path with a space would be two libraries.
    std::filesystem::create_symlink(VANTAGE_CLOCK_SET, at("clock_set.so"));
    for (const auto& [signal, step] : {std::pair(SIGUSR1, "+7200000"), {SIGUSR2, "-7200000"}}) {
        ChildProgram rig(
            VANTAGE_RIG, {"run", "--config", write_config(small_stage), "--frames", "30", "--json"},
            folder_.path(), {"LD_PRELOAD=" + at("clock_set.so").string(), "CLOCK_SET_MS=7200000"});
        rig.wait_for("publishing on");
        std::this_thread::sleep_for(500ms);
        rig.send_signal(signal);
        const ProgramResult result = rig.wait();
        ASSERT_EQ(result.status, 0) << result.err;
        EXPECT_NE(result.err.find(fmt::format("this computer's clock was set by {}.", step)),
                  std::string::npos)
            << result.err;
        const nlohmann::json summary = nlohmann::json::parse(result.out);
        EXPECT_EQ(summary.at("published"), 30);
        expect_stats_to_balance(summary);
        // The 72 000 pulses that the clock leapt over were not missed.
        constexpr int pulses_of_the_run = 300;
        EXPECT_LT(summary.at("missed").get<int>(), pulses_of_the_run);
        EXPECT_LT(summary.at("capture_ms").at("max").get<double>(), 60'000);
    }
}

TEST_F(RunCommandTest, NamesALimitOfOpenFilesThatIsTooLow) {
    const ProgramResult result =
        run_to_end("/bin/sh", {"-c", "ulimit -n 20; exec \"$0\" run --config \"$1\"", VANTAGE_RIG,
                               write_config(small_stage)});
    EXPECT_EQ(result.status, 1);
    EXPECT_NE(result.err.find("a rig needs"), std::string::npos) << result.err;
    EXPECT_NE(result.err.find("ulimit -n"), std::string::npos) << result.err;
}

TEST_F(RunCommandTest, EndsWhereTheMaterialEnds) {
    for (int i = 0; i < 4; ++i) {
        write_picture(fmt::format("l{}.png", i), {61, 47});
        write_picture(fmt::format("r{}.png", i), {61, 47});
    }
    std::string config = replaced(small_stage, "\"virtual\"", "\"files\"\nloop = false");
    config = replaced(config, "[match]", "left = \"l%d.png\"\nright = \"r%d.png\"\n[match]");
    const ProgramResult result = run(config, {"--json"});
    ASSERT_EQ(result.status, 0) << result.err;
    const nlohmann::json summary = nlohmann::json::parse(result.out);
    expect_stats_to_balance(summary);
    EXPECT_EQ(summary.at("captured").get<int>() + summary.at("missed").get<int>(), 4);
}

TEST_F(RunCommandTest, PassesExactDisparityThrough) {
    const ProgramResult result =
        run(replaced(small_stage, "[match]", "[match]\nmatcher = \"exact\""),
            {"--frames", "2", "--json"});
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_EQ(nlohmann::json::parse(result.out).at("published"), 2);
    EXPECT_NE(result.err.find("matcher exact"), std::string::npos);
}

TEST_F(RunCommandTest, RefusesAConfigurationWithOneSentence) {
    const ProgramResult missing =
        run_to_end(VANTAGE_RIG, {"run", "--config", at("none.toml").string()});
    EXPECT_EQ(missing.status, 1);
    EXPECT_NE(missing.err.find("none.toml"), std::string::npos);
    expect_refusal(replaced(small_stage, "rate_hz", "rate_hs"),
                   "rig.toml:6: there is no key 'rate_hs' in [source]; the nearest is 'rate_hz'");
    expect_refusal(replaced(small_stage, "= 61", "= \"61\""),
                   "rig.toml:7: 'width_px' in [source] must be an integer");
    expect_refusal(replaced(small_stage, "= 16", "= 257"),
                   "'disparities' in [match] is 257, but must be 1 to 256");
    expect_refusal(replaced(small_stage, "\"virtual\"", "\"virtuel\""), "'virtuel'");
    expect_refusal(replaced(small_stage, "[match]", "[match]\nmatcher = \"gradiant\""),
                   "no matcher named 'gradiant'");
}

TEST_F(RunCommandTest, RefusesPicturesThatCannotBe) {
    std::string config =
        replaced(small_stage, "\"virtual\"", "\"files\"\nleft = \"l.png\"\nright = \"r.png\"");
    expect_refusal(config, "l.png");
    write_picture("l.png", {61, 47});
    write_picture("r.png", {60, 47});
    expect_refusal(config, "is 60x47");
    std::ofstream(at("r.png")) << "no picture";
    expect_refusal(config, "r.png");
    write_picture("r.png", {61, 47});
    expect_refusal(replaced(config, "[match]", "[match]\nmatcher = \"exact\""),
                   "'matcher = \"exact\"'");
}

TEST_F(RunCommandTest, NamesThePictureThatIsDamagedOnTheWay) {
    for (int i = 0; i < 3; ++i) write_picture(fmt::format("b{}.png", i), {122, 47});
    std::ofstream(at("b1.png")) << "no picture";
    const ProgramResult result = run(
        replaced(small_stage, "\"virtual\"", "\"files\"\nleft = \"b%d.png\"\nside_by_side = true"));
    EXPECT_EQ(result.status, 1);
    EXPECT_NE(result.err.find("b1.png"), std::string::npos) << result.err;
}

TEST_F(RunCommandTest, RefusesACalibrationThatDoesNotFit) {
    const std::string config =
        replaced(small_stage, "[source]", "calibration = \"c.yaml\"\n[source]");
    expect_refusal(config, "c.yaml");
    std::ofstream(at("c.yaml")) << "%YAML:1.0\n---\nkind: none\n";
    expect_refusal(config, "this is not a calibration of Vantage");
    RectifiedStereo geometry = {.width_px = 64,
                                .height_px = 48,
                                .f_px = 60,
                                .cx_left_px = 31.5,
                                .cx_right_px = 31.5,
                                .cy_px = 23.5,
                                .baseline_m = 0.1};
    save_calibration(at("c.yaml"), rectified_calibration(geometry), {});
    expect_refusal(config, "is for left pictures of 64x48");
}

TEST_F(RunCommandTest, RefusesAStreamThatCannotBe) {
    const UniqueFd taken(::socket(AF_INET, SOCK_STREAM, 0));
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t length = sizeof address;
    auto* generic = reinterpret_cast<sockaddr*>(&address);
    ASSERT_EQ(::bind(taken.get(), generic, length), 0);
    ASSERT_EQ(::listen(taken.get(), 1), 0);
    ASSERT_EQ(::getsockname(taken.get(), generic, &length), 0);
    const std::string endpoint = fmt::format("127.0.0.1:{}", ntohs(address.sin_port));
    expect_refusal(replaced(small_stage, "127.0.0.1:*", endpoint), "is in use");
    expect_refusal(replaced(small_stage, "127.0.0.1:*", "0.0.0.0:*"), "needs keys");
    expect_refusal(small_stage + "key_file = \"none.key\"\nauthorized_hosts = \"none\"\n",
                   "none.key");
}

TEST_F(RunCommandTest, SaysWhatWasTriedWhereThereIsNoOpenGl) {
    const std::string sentence =
        refusal(small_stage, {"__EGL_VENDOR_LIBRARY_FILENAMES=/nonexistent"});
    EXPECT_NE(sentence.find("no OpenGL ES"), std::string::npos) << sentence;
    EXPECT_NE(sentence.find("surfaceless"), std::string::npos) << sentence;
}

TEST_F(RunCommandTest, SendsPulsesAtOnceOrWaitsForTheHostsWord) {
    const std::string lead =
        small_stage + "[trigger]\nrole = \"lead\"\npretended = true\nlate_limit_us = 1000000\n";
    ChildProgram rig(VANTAGE_RIG, {"run", "--config", write_config(lead), "--json"},
                     folder_.path());
    rig.wait_for("publishing on");
    // At 10 Hz: time for as many pictures as a rig without a trigger would have filmed.
    std::this_thread::sleep_for(1s);
    rig.send_signal(SIGTERM);
    const ProgramResult waiting = rig.wait();
    ASSERT_EQ(waiting.status, 0) << waiting.err;
    const auto summary = nlohmann::json::parse(waiting.out);
    const auto& armed = summary["sync"];
    EXPECT_TRUE(armed["ready"]) << armed;
    EXPECT_EQ(armed["first_pulse"], 0) << armed;
    EXPECT_EQ(armed["pulses"], 0) << armed;
    EXPECT_EQ(summary["captured"], 0) << "no pulse, no picture";
    EXPECT_NE(waiting.err.find("armed: pulses begin when the host announces"), std::string::npos)
        << waiting.err;
    const ProgramResult sending = run(lead + "start = \"at_once\"\n", {"--frames", "9", "--json"});
    ASSERT_EQ(sending.status, 0) << sending.err;
    const auto sync = nlohmann::json::parse(sending.out)["sync"];
    EXPECT_GT(sync["first_pulse"], 0) << sync;
    EXPECT_GT(sync["pulses"], 0) << sync;
    EXPECT_GT(sync["lateness_us"]["max"], 0) << sync;
}

TEST_F(RunCommandTest, RefusesARateThatTheSensorCannotFollow) {
    expect_refusal(replaced(small_stage, "rate_hz = 10", "rate_hz = 60") +
                       "[trigger]\nrole = \"lead\"\npretended = true\nsensor = \"imx296\"\n",
                   "21560.00 us, and a period at 60 Hz is 16666.67 us");
}

}  // namespace
}  // namespace vantage
