#include "host_app/output/media/shared_encoder.h"

#include <algorithm>
#include <filesystem>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "common/base/error.h"
#include "host_app/output/output_supervisor.h"
#include "host_app/output/stream_target.h"
#include "tests/support/child_program.h"
#include "tests/support/data_folder.h"
#include "tests/support/free_ports.h"
#include "tests/unit/host_app/output/given_pictures.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;

constexpr int width_px = 160, height_px = 120;

/// The frames that a stream target has received. While it hangs, it takes no more.
struct Received {
    std::mutex mutex;
    std::vector<EncodedPicture> pictures;
    std::vector<std::int64_t> ticks;
    std::atomic<bool> hangs = false;

    std::size_t count() {
        const std::lock_guard lock(mutex);
        return pictures.size();
    }
};

class RecordingTarget final : public OutputTarget {
  public:
    RecordingTarget(std::shared_ptr<SharedEncoder> encoder, std::shared_ptr<Received> received,
                    const OutputPatience& patience)
        : use_(std::move(encoder)), received_(std::move(received)), patience_(patience) {}
    void write_encoded(const EncodedPicture& picture, std::int64_t tick) override {
        while (received_->hangs && !patience_.is_over()) std::this_thread::sleep_for(1ms);
        const std::lock_guard lock(received_->mutex);
        received_->pictures.push_back(picture);
        received_->ticks.push_back(tick);
    }
    std::uint64_t bytes() const override { return 0; }

  private:
    SharedEncoder::Use use_;
    std::shared_ptr<Received> received_;
    const OutputPatience& patience_;
};

/// Outputs of one encoder of 25 Hz that works faster than real time.
class SharedEncoderTest : public testing::Test {
  protected:
    struct Line {
        std::shared_ptr<Received> received = std::make_shared<Received>();
        std::unique_ptr<Output> output;
        OutputState state() const { return output->state(); }
    };
    Line& add() {
        Line& line = *lines_.emplace_back(std::make_unique<Line>());
        OutputPlan plan;
        plan.name = fmt::format("line {}", lines_.size());
        plan.is_stream = true;
        plan.encoder = encoder_;
        plan.open = [encoder = encoder_, received = line.received](const OutputPatience& patience) {
            return std::make_unique<RecordingTarget>(encoder, received, patience);
        };
        line.output = std::make_unique<Output>(std::move(plan), OutputFormat{}, 25);
        line.output->start();
        EXPECT_TRUE(wait_for([&] { return line.state().phase == OutputPhase::on; }));
        return line;
    }
    /// Gives the next frames to all outputs, no faster than they take them, but for those that
    /// hang.
    void give(int count) {
        for (int i = 0; i < count; ++i, ++tick_) {
            const std::uint64_t before = encoder_->encoded();
            for (const auto& line : lines_)
                line->output->take(
                    given_picture(tick_, static_cast<int>(5 * tick_ % 200), width_px, height_px));
            ASSERT_TRUE(wait_for([&] {
                return encoder_->encoded() > before &&
                       std::all_of(lines_.begin(), lines_.end(), [](const auto& line) {
                           return line->received->hangs || line->state().queued < 4;
                       });
            }));
        }
    }
    /// Ends everything and checks that every frame is in one counter.
    void end() {
        for (const auto& line : lines_) {
            line->output->finish();
            const OutputState state = line->state();
            EXPECT_EQ(state.queued, 0u) << state.name;
            EXPECT_EQ(state.pictures, line->received->count()) << state.name;
        }
    }
    /// Every frame follows the one before, but for gaps that end with a key frame.
    static void expect_decodable(const Received& received) {
        ASSERT_FALSE(received.pictures.empty());
        EXPECT_TRUE(received.pictures.front().is_key);
        for (std::size_t i = 1; i < received.pictures.size(); ++i)
            EXPECT_TRUE(received.pictures[i].is_key ||
                        received.pictures[i].number == received.pictures[i - 1].number + 1)
                << i;
    }

    std::shared_ptr<SharedEncoder> encoder_ =
        std::make_shared<SharedEncoder>("libx264", EncoderSettings{.width_px = width_px,
                                                                   .height_px = height_px,
                                                                   .rate_hz = 25,
                                                                   .bit_rate_bps = 500'000,
                                                                   .is_live = true});
    std::vector<std::unique_ptr<Line>> lines_;
    std::uint64_t tick_ = 1000;  ///< the programme has run for long
};

TEST_F(SharedEncoderTest, EncodesEachFrameOnceForAllOutputs) {
    for (int i = 0; i < 3; ++i) add();
    give(30);
    end();
    EXPECT_EQ(encoder_->encoded(), 30u);
    for (const auto& line : lines_) {
        ASSERT_EQ(line->received->pictures.size(), 30u);
        EXPECT_EQ(line->received->ticks.front(), 0);
        EXPECT_EQ(line->received->ticks.back(), 29);
        for (std::size_t i = 0; i < 30; ++i)
            EXPECT_EQ(line->received->pictures[i].packet.get(),
                      lines_.front()->received->pictures[i].packet.get())
                << "the bytes are not copied";
        EXPECT_EQ(line->state().pictures, 30u);
        EXPECT_EQ(line->state().dropped, 0u);
    }
}

TEST_F(SharedEncoderTest, AnOutputThatJoinsLaterBeginsWithAKeyFrame) {
    Line& first = add();
    give(20);
    Line& later = add();
    give(20);
    end();
    EXPECT_EQ(encoder_->encoded(), 40u);
    expect_decodable(*first.received);
    expect_decodable(*later.received);
    EXPECT_EQ(first.state().pictures, 40u);
    EXPECT_EQ(later.state().pictures + later.state().unheard, 20u);
    EXPECT_GE(later.state().pictures, 19u) << "it does not wait for the key frame of each second";
    EXPECT_EQ(later.state().dropped, 0u);
    EXPECT_EQ(later.received->ticks.front(), 0) << "its time begins with its first frame";
}

TEST_F(SharedEncoderTest, ASlowOutputIsDroppedAndCountedAlone) {
    Line& fast = add();
    Line& slow = add();
    give(10);
    ASSERT_TRUE(wait_for([&] { return slow.received->count() == 10; }));
    slow.received->hangs = true;
    give(40);
    slow.received->hangs = false;
    give(1);
    ASSERT_TRUE(wait_for([&] { return slow.state().queued == 0; }));
    give(20);
    end();
    EXPECT_EQ(fast.state().pictures, 71u);
    EXPECT_EQ(fast.state().dropped, 0u);
    expect_decodable(*fast.received);
    const OutputState state = slow.state();
    EXPECT_GE(state.dropped, 40u - 1 - 8);
    EXPECT_EQ(state.offered, state.pictures + state.dropped + state.unheard);
    EXPECT_GE(state.pictures, 10u + 5) << "it goes on soon";
    expect_decodable(*slow.received);
    EXPECT_EQ(slow.received->ticks.back(), 70);
}

TEST_F(SharedEncoderTest, GoesOnWithoutAnOutputThatEnds) {
    Line& first = add();
    Line& second = add();
    give(10);
    first.output->stop();
    ASSERT_TRUE(wait_for([&] { return first.state().phase == OutputPhase::off; }));
    give(10);
    first.output->start();
    ASSERT_TRUE(wait_for([&] { return first.state().phase == OutputPhase::on; }));
    give(10);
    end();
    EXPECT_EQ(second.state().pictures, 30u);
    EXPECT_GE(first.state().pictures, 19u);
    expect_decodable(*second.received);
    expect_decodable(*first.received);
}

TEST_F(SharedEncoderTest, WritesAllThatWaitsInTheEncoderAtTheEnd) {
    Line& line = add();
    for (int i = 0; i < 5; ++i, ++tick_)
        line.output->take(given_picture(tick_, 90, width_px, height_px));
    end();
    EXPECT_EQ(line.state().pictures, 5u);
}

TEST(EncoderPool, SharesOnlyWhatIsEqual) {
    EncoderPool pool;
    const EncoderSettings settings{
        .width_px = 64, .height_px = 48, .bit_rate_bps = 500'000, .is_live = true};
    EncoderSettings other_rate = settings, other_size = settings, other_bits = settings;
    other_rate.rate_hz = 50;
    other_size.width_px = 128;
    other_bits.bit_rate_bps = 600'000;
    const auto one = pool.find("libx264", settings);
    EXPECT_EQ(pool.find("libx264", settings), one);
    EXPECT_NE(pool.find("mpeg4", settings), one);
    for (const EncoderSettings& other : {other_rate, other_size, other_bits})
        EXPECT_NE(pool.find("libx264", other), one);
}

/// Three real streams of FFmpeg: two over UDP and one over SRT.
TEST(SharedStreams, AreEncodedOnceAndReachEveryReceiver) {
    const std::filesystem::path ffprobe = "/usr/bin/ffprobe";
    if (!std::filesystem::exists(ffprobe)) GTEST_SKIP() << "SKIPPED: ffprobe is not installed";
    const auto [udp, second_udp] = two_free_ports();
    const int srt = two_free_ports().first;
    OutputSupervisor desk(
        {.format =
             {.width_px = width_px, .height_px = height_px, .rate_hz = 25, .encoder = "libx264"},
         .pulse_rate_hz = 25,
         .urls = {fmt::format("udp://127.0.0.1:{}", udp),
                  fmt::format("udp://127.0.0.1:{}", second_udp),
                  fmt::format("srt://127.0.0.1:{}?mode=listener&latency=200", srt)}});
    const auto sink = desk.sink();
    std::jthread feeder([&](const std::stop_token& stop) {
        for (std::uint64_t tick = 0; !stop.stop_requested(); ++tick) {
            sink->take(given_picture(tick, static_cast<int>(tick % 200), width_px, height_px));
            std::this_thread::sleep_for(20ms);
        }
    });
    const TemporaryFolder folder;
    std::vector<std::unique_ptr<ChildProgram>> receivers;
    for (const std::string& url : {fmt::format("udp://127.0.0.1:{}?timeout=60000000", udp),
                                   fmt::format("udp://127.0.0.1:{}?timeout=60000000", second_udp),
                                   fmt::format("srt://127.0.0.1:{}?connect_timeout=60000", srt)}) {
        std::filesystem::create_directories(folder.path() / std::to_string(receivers.size()));
        receivers.push_back(std::make_unique<ChildProgram>(
            "/usr/bin/timeout",
            std::vector<std::string>{"60", ffprobe.string(), "-v", "error", "-read_intervals",
                                     "%+#50", "-count_frames", "-show_entries",
                                     "stream=codec_name,nb_read_frames", "-of", "json", url},
            folder.path() / std::to_string(receivers.size())));
    }
    for (const auto& receiver : receivers) {
        const ProgramResult result = receiver->wait();
        ASSERT_EQ(result.status, 0) << result.err;
        const nlohmann::json stream = nlohmann::json::parse(result.out)["streams"][0];
        EXPECT_EQ(stream["codec_name"], "h264");
        EXPECT_GE(std::stoi(stream["nb_read_frames"].get<std::string>()), 40) << result.err;
    }
    feeder.request_stop();
    feeder.join();
    desk.finish();
    std::uint64_t most = 0;
    for (const OutputState& state : desk.states()) {
        EXPECT_EQ(state.offered, state.pictures + state.dropped + state.unheard) << state.name;
        EXPECT_GE(state.pictures, 50u) << state.name;
        most = std::max(most, state.offered);
    }
    EXPECT_GT(desk.encoded(), 0u);
    EXPECT_LE(desk.encoded(), most) << "each tick at most once";
}

}  // namespace
}  // namespace vantage
