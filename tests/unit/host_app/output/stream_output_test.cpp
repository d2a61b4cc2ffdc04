#include <cmath>
#include <filesystem>
#include <thread>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "host_app/output/output_supervisor.h"
#include "tests/support/child_program.h"
#include "tests/support/data_folder.h"
#include "tests/support/free_ports.h"
#include "tests/unit/host_app/output/given_pictures.h"
#include "tests/unit/host_app/output/probed_film.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;

const std::filesystem::path ffprobe = "/usr/bin/ffprobe", ffmpeg = "/usr/bin/ffmpeg",
                            transmit = "/usr/bin/srt-live-transmit";

/// A programme of 29.97 Hz, faster than real time, whose stream a real peer takes. It offers no
/// more than the output can take, so that on a busy computer nothing is left out before it is sent.
class StreamOutputTest : public testing::Test {
  protected:
    StreamOutputTest() {
        if (!std::filesystem::exists(ffprobe) || !std::filesystem::exists(ffmpeg))
            skipped_ = "SKIPPED: ffmpeg is not installed";
    }
    ~StreamOutputTest() override { feeder_.request_stop(); }
    void SetUp() override {
        if (!skipped_.empty()) GTEST_SKIP() << skipped_;
    }

    void begin(const std::string& url) {
        output_.emplace(plan_output(url, format_), format_, 30);
        output_->start();
        feeder_ = std::jthread([this](const std::stop_token& stop) {
            for (std::uint64_t tick = 0; !stop.stop_requested();) {
                const OutputState state = output_->state();
                constexpr std::uint64_t most_waiting = 4;
                if (state.offered - state.pictures - state.dropped - state.unheard < most_waiting) {
                    output_->take(given_picture(tick, static_cast<int>(tick % 200), 160, 120));
                    ++tick;
                }
                std::this_thread::sleep_for(8ms);
            }
        });
    }
    void end() {
        feeder_.request_stop();
        feeder_.join();
        output_->finish();
        const OutputState state = output_->state();
        EXPECT_EQ(state.offered, state.pictures + state.dropped + state.unheard);
    }
    std::string address(const std::string& scheme, const std::string& options = "") const {
        return fmt::format("{}://127.0.0.1:{}{}", scheme, port_, options);
    }

    /// What ffprobe takes of a stream until it has seen that many packets: their times.
    static std::vector<double> times_of(const std::string& url, int packets = 90) {
        const ProgramResult result = run_to_end(
            "/usr/bin/timeout",
            {"60", ffprobe.string(), "-v", "error", "-analyzeduration", "1000000",
             "-read_intervals", fmt::format("%+#{}", packets), "-show_entries",
             "packet=pts_time:stream=codec_name,r_frame_rate,width", "-of", "json", url});
        EXPECT_EQ(result.status, 0) << result.err;
        std::vector<double> times;
        if (result.status != 0) return times;
        const nlohmann::json json = nlohmann::json::parse(result.out);
        EXPECT_EQ(json["streams"][0]["codec_name"], "h264");
        EXPECT_EQ(json["streams"][0]["r_frame_rate"], "30000/1001");
        EXPECT_EQ(json["streams"][0]["width"], 160);
        for (const nlohmann::json& packet : json["packets"])
            times.push_back(std::stod(packet["pts_time"].get<std::string>()));
        return times;
    }
    /// Whole pictures at a constant rate, of which none is missing. MPEG-TS counts 1/90000 s.
    static void expect_no_gap(const std::vector<double>& times, std::size_t pictures) {
        ASSERT_GE(times.size(), pictures);
        for (std::size_t i = 1; i < times.size(); ++i)
            ASSERT_NEAR(times[i] - times[i - 1], 1001.0 / 30000, 2e-6) << i;
    }
    /// Pictures at a constant rate, of which a road without repair may have lost some on a busy
    /// computer.
    static void expect_on_grid(const std::vector<double>& times, std::size_t pictures,
                               double tolerance_s) {
        ASSERT_GE(times.size(), pictures);
        constexpr double period_s = 1001.0 / 30000;
        for (std::size_t i = 1; i < times.size(); ++i) {
            const double step_s = times[i] - times[i - 1];
            ASSERT_GT(step_s, period_s / 2) << i;
            ASSERT_NEAR(step_s, std::round(step_s / period_s) * period_s, tolerance_s) << i;
        }
    }

    std::string skipped_;
    TemporaryFolder folder_;
    int port_ = two_free_ports().first;
    OutputFormat format_{.width_px = 160, .height_px = 120, .rate_hz = 29.97};
    std::optional<Output> output_;
    std::jthread feeder_;
};

TEST_F(StreamOutputTest, SrtServesOneCallerAfterTheOtherWhoKnowsThePassphrase) {
    const std::string phrase = "passphrase=open-sesame-1";
    begin(address("srt", "?mode=listener&latency=2000&" + phrase));
    ASSERT_TRUE(wait_for([&] { return output_->state().phase == OutputPhase::waiting; }));
    expect_no_gap(times_of(address("srt", "?connect_timeout=30000&" + phrase)), 90);
    ASSERT_TRUE(wait_for([&] { return output_->state().phase == OutputPhase::waiting; }))
        << "for the next one";
    const ProgramResult stranger = run_to_end(
        "/usr/bin/timeout",
        {"20", ffprobe.string(), "-v", "error", address("srt", "?passphrase=another-phrase")});
    EXPECT_NE(stranger.status, 0) << "has the wrong passphrase";
    expect_no_gap(times_of(address("srt", "?connect_timeout=30000&" + phrase)), 90);
    end();
    EXPECT_GT(output_->state().unheard, 0u);
}

TEST_F(StreamOutputTest, ACallerOfSrtThatLeavesIsNoFailure) {
    begin(address("srt", "?mode=listener&latency=2000"));
    ASSERT_TRUE(wait_for([&] { return output_->state().phase == OutputPhase::waiting; }));
    (void)times_of(address("srt", "?connect_timeout=30000"), 30);
    ASSERT_TRUE(wait_for([&] { return output_->state().callers_left == 1; }));
    EXPECT_EQ(output_->state().failures, 0u);
    EXPECT_EQ(output_->state().failure, "");
    ASSERT_TRUE(wait_for([&] { return output_->state().phase == OutputPhase::waiting; }));
    end();
    EXPECT_EQ(output_->state().phase, OutputPhase::off);
    EXPECT_EQ(output_->state().failure, "");
}

TEST_F(StreamOutputTest, SrtCallsUntilSomebodyListens) {
    begin(address("srt", "?latency=2000"));
    ASSERT_TRUE(wait_for([&] { return output_->state().phase == OutputPhase::failed; }));
    EXPECT_NE(output_->state().failure.find(address("srt")), std::string::npos)
        << output_->state().failure;
    expect_no_gap(times_of(address("srt", "?mode=listener")), 90);
    EXPECT_GT(output_->state().pictures, 0u);
    end();
}

TEST_F(StreamOutputTest, SrtSaysWhatMayBeWrongWhereAListenerRefusesIt) {
    ChildProgram listener(
        ffmpeg.string(),
        {"-v", "error", "-i", address("srt", "?mode=listener&passphrase=open-sesame-1"), "-f",
         "null", "-"},
        folder_.path());
    begin(address("srt", "?passphrase=another-phrase"));
    ASSERT_TRUE(wait_for([&] { return output_->state().phase == OutputPhase::failed; }));
    EXPECT_NE(output_->state().failure.find("another passphrase"), std::string::npos)
        << output_->state().failure;
    end();
    EXPECT_EQ(output_->state().pictures, 0u);
    listener.send_signal(SIGKILL);
}

TEST_F(StreamOutputTest, SrtGoesThroughTheReferenceProgram) {
    if (!std::filesystem::exists(transmit)) GTEST_SKIP() << "SKIPPED: srt-tools is not installed";
    begin(address("srt", "?mode=listener&latency=2000"));
    ASSERT_TRUE(wait_for([&] { return output_->state().phase == OutputPhase::waiting; }));
    const std::filesystem::path file = folder_.path() / "feed.ts";
    {
        ChildProgram peer("/bin/sh",
                          {"-c", fmt::format("exec {} -q '{}' file://con > '{}'", transmit.string(),
                                             address("srt"), file.string())},
                          folder_.path());
        ASSERT_TRUE(wait_for([&] { return output_->state().pictures > 500; }));
        peer.send_signal(SIGINT);
        peer.wait();
    }
    expect_no_gap(probe_film(file).times_s, 60);
    end();
}

TEST_F(StreamOutputTest, MpegTsGoesOverUdp) {
    begin(address("udp"));
    expect_on_grid(times_of(address("udp")), 90, 2e-6);
    end();
    EXPECT_EQ(output_->state().failures, 0u);
}

TEST_F(StreamOutputTest, RistGoesEncryptedToWhoKnowsThePassphrase) {
    begin(address("rist", "?passphrase=open-sesame-1"));
    const std::string listening = fmt::format("rist://@127.0.0.1:{}", port_);
    const ProgramResult result = run_to_end(
        "/usr/bin/timeout",
        {"60", ffmpeg.string(), "-v", "error", "-secret", "open-sesame-1", "-encryption", "128",
         "-i", listening, "-c", "copy", "-frames:v", "90", (folder_.path() / "feed.mkv").string()});
    EXPECT_EQ(result.status, 0) << result.err;
    end();
    expect_on_grid(probe_film(folder_.path() / "feed.mkv").times_s, 80, 0.0011);
}

TEST_F(StreamOutputTest, ADeviceThatIsNoneFailsAlone) {
    for (const std::string device : {"/dev/null", "/dev/no-such-video"}) {
        Output output(plan_output("v4l2:" + device, format_), format_, 30);
        output.start();
        ASSERT_TRUE(wait_for([&] { return output.state().phase == OutputPhase::failed; }));
        EXPECT_NE(output.state().failure.find(device), std::string::npos) << output.state().failure;
        output.finish();
    }
}

}  // namespace
}  // namespace vantage
