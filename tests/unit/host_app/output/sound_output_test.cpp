#include <filesystem>
#include <thread>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "host_app/output/output_supervisor.h"
#include "host_app/output/stream_target.h"
#include "tests/support/child_program.h"
#include "tests/support/clicks.h"
#include "tests/support/data_folder.h"
#include "tests/support/free_ports.h"
#include "tests/unit/host_app/output/given_pictures.h"
#include "tests/unit/host_app/output/probed_film.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;

/// A programme with a click a second, as other programs find it.
class SoundOutputTest : public testing::Test {
  protected:
    SoundOutputTest() {
        if (!std::filesystem::exists("/usr/bin/ffmpeg")) skipped_ = "SKIPPED: no ffmpeg";
    }
    void SetUp() override {
        if (!skipped_.empty()) GTEST_SKIP() << skipped_;
    }
    std::string at(const std::string& name) const { return (folder_.path() / name).string(); }

    ProgrammePicture picture(std::uint64_t tick) const {
        ProgrammePicture picture =
            given_picture(tick, static_cast<int>(tick % 200), format_.width_px, format_.height_px);
        auto block = std::make_shared<SoundBlock>();
        const SoundGrid grid(format_.rate_hz);
        const auto here = static_cast<std::int64_t>(tick);
        block->first = grid.first_of(here);
        const std::int64_t end = grid.first_of(here + 1);
        const auto begin = sound_.begin() + static_cast<std::ptrdiff_t>(2 * block->first);
        block->samples.assign(begin, begin + static_cast<std::ptrdiff_t>(2 * (end - block->first)));
        picture.sound = std::move(block);
        return picture;
    }
    /// Of which none is left out.
    void give(Output& output, std::uint64_t from, std::uint64_t count) const {
        for (std::uint64_t i = 0; i < count; ++i) {
            ASSERT_TRUE(wait_for([&] { return output.state().queued < 8; }));
            output.take(picture(from + i));
        }
    }
    void film(const std::string& url, std::uint64_t ticks, std::uint64_t from = 0) const {
        Output output(plan_output(url, format_), format_, 25);
        output.start();
        give(output, from, ticks);
        output.finish();
        EXPECT_EQ(output.state().failure, "");
        EXPECT_EQ(output.state().silenced, 0u);
    }

    struct Heard {
        std::string codec, rate;
        std::vector<float> samples;
        double first_s = 0;    ///< of the sound, as the container says
        double picture_s = 0;  ///< of the first picture
    };
    /// As FFmpeg decodes it.
    Heard heard(const std::string& file) const {
        Heard heard;
        const ProgramResult probed = run_to_end(
            "/usr/bin/ffprobe",
            {"-v", "error", "-show_entries",
             "stream=codec_type,codec_name,sample_rate,channels,start_time", "-of", "json", file});
        EXPECT_EQ(probed.status, 0) << probed.err;
        const nlohmann::json json = nlohmann::json::parse(probed.out);
        for (const nlohmann::json& stream : json["streams"]) {
            const double start_s = std::stod(stream.value("start_time", std::string("0")));
            if (stream["codec_type"] == "video") heard.picture_s = start_s;
            if (stream["codec_type"] != "audio") continue;
            heard.codec = stream["codec_name"];
            heard.rate = stream["sample_rate"];
            heard.first_s = start_s;
            EXPECT_EQ(stream["channels"], 2);
        }
        const std::string raw = at("heard.raw");
        const ProgramResult decoded =
            run_to_end("/usr/bin/ffmpeg",
                       {"-v", "error", "-y", "-i", file, "-map", "0:a", "-f", "f32le", raw});
        EXPECT_EQ(decoded.status, 0) << decoded.err;
        heard.samples.resize(std::filesystem::file_size(raw) / sizeof(float));
        std::ifstream(raw, std::ios::binary)
            .read(reinterpret_cast<char*>(heard.samples.data()),
                  static_cast<std::streamsize>(heard.samples.size() * sizeof(float)));
        return heard;
    }
    /// Every second a click, and as long as the pictures.
    void expect_clicks(const Heard& heard, std::uint64_t ticks, double tolerance_s) const {
        EXPECT_EQ(heard.rate, "48000");
        const double ahead_s = heard.first_s - heard.picture_s;
        // A frame of AAC is 21 ms.
        const double least_s = std::max(1 / format_.rate_hz, 0.022);
        EXPECT_NEAR(ahead_s, 0, least_s);
        const double duration_s = static_cast<double>(ticks) / format_.rate_hz;
        EXPECT_NEAR(static_cast<double>(heard.samples.size()) / sound_channels / sound_rate_hz,
                    duration_s - ahead_s, least_s);
        const std::vector<std::int64_t> found = found_clicks(heard.samples);
        ASSERT_EQ(found.size(), static_cast<std::size_t>(duration_s));
        for (std::size_t i = 0; i < found.size(); ++i)
            EXPECT_NEAR(static_cast<double>(found[i]) / sound_rate_hz + ahead_s,
                        static_cast<double>(i + 1), tolerance_s);
    }

    std::string skipped_;
    TemporaryFolder folder_;
    OutputFormat format_{
        .width_px = 64, .height_px = 48, .rate_hz = 25, .overwrites = true, .has_sound = true};
    std::vector<float> sound_ = clicks(40);
};

TEST_F(SoundOutputTest, AMatroskaFilmHasEverySampleAsItWas) {
    film(at("film.mkv"), 110);
    const Heard heard = this->heard(at("film.mkv"));
    EXPECT_EQ(heard.codec, "pcm_s24le");
    expect_clicks(heard, 110, 0);
    ASSERT_EQ(heard.samples.size(), 110u * 1920 * sound_channels);
    for (std::size_t i = 0; i < heard.samples.size(); ++i)
        ASSERT_NEAR(heard.samples[i], sound_[i], 1.0 / (1 << 23)) << i;
    EXPECT_EQ(probe_film(at("film.mkv")).times_s.size(), 110u);
}

TEST_F(SoundOutputTest, AnMp4FilmHasAacThatBeginsWithThePicture) {
    for (const double rate_hz : {25.0, 29.97, 60.0}) {
        format_.rate_hz = rate_hz;
        film(at("film.mp4"), 137);
        const Heard heard = this->heard(at("film.mp4"));
        EXPECT_EQ(heard.codec, "aac");
        expect_clicks(heard, 137, 0.002);
    }
}

TEST_F(SoundOutputTest, SegmentsLackNoSampleBetweenThem) {
    film(at("film.mkv") + "?segment=1s", 110);
    std::vector<float> joined;
    for (int part = 1; part <= 5; ++part) {
        const Heard heard = this->heard(at(fmt::format("film-{:03}.mkv", part)));
        joined.insert(joined.end(), heard.samples.begin(), heard.samples.end());
    }
    ASSERT_EQ(joined.size(), 110u * 1920 * sound_channels);
    for (std::size_t i = 0; i < joined.size(); ++i)
        ASSERT_NEAR(joined[i], sound_[i], 1.0 / (1 << 23)) << i;
}

TEST_F(SoundOutputTest, WhatBeginsLaterBeginsWithTheSoundOfItsFirstPicture) {
    film(at("film.mkv"), 60, 20);
    const std::vector<std::int64_t> found = found_clicks(heard(at("film.mkv")).samples);
    EXPECT_EQ(found, (std::vector<std::int64_t>{9'600, 57'600, 105'600}));
}

/// Hears what it is given, and waits as long as the test says.
class HearingTarget final : public OutputTarget {
  public:
    struct Notes {
        std::mutex mutex;
        std::vector<std::int64_t> seen, heard;
        std::atomic<bool> waits = true;
    };
    explicit HearingTarget(std::shared_ptr<Notes> notes) : notes_(std::move(notes)) {}
    void write(const ColourImage&, std::int64_t tick, const std::string&) override {
        while (notes_->waits) std::this_thread::sleep_for(1ms);
        const std::lock_guard lock(notes_->mutex);
        notes_->seen.push_back(tick);
    }
    void hear(const SoundBlock&, std::int64_t tick) override {
        const std::lock_guard lock(notes_->mutex);
        notes_->heard.push_back(tick);
    }
    std::uint64_t bytes() const override { return 0; }

  private:
    std::shared_ptr<Notes> notes_;
};

TEST_F(SoundOutputTest, SoundOutlastsPicturesThatAreLeftOutForTwoSeconds) {
    const auto notes = std::make_shared<HearingTarget::Notes>();
    OutputPlan plan;
    plan.name = "slow";
    plan.takes_sound = true;
    plan.open = [notes](const OutputPatience&) { return std::make_unique<HearingTarget>(notes); };
    Output output(std::move(plan), format_, 25);
    output.start();
    ASSERT_TRUE(wait_for([&] { return output.state().phase == OutputPhase::on; }));
    output.take(picture(0));
    ASSERT_TRUE(wait_for([&] { return output.state().queued == 1; }));
    std::this_thread::sleep_for(100ms);
    for (std::uint64_t tick = 1; tick < 80; ++tick) output.take(picture(tick));
    notes->waits = false;
    output.finish();
    ASSERT_EQ(notes->seen.size(), 9u);
    EXPECT_EQ(output.state().dropped, 71u);
    EXPECT_EQ(output.state().silenced + notes->heard.size(), 80u) << "all is accounted for";
    ASSERT_GE(notes->heard.size(), 51u);
    for (std::size_t i = 1; i < notes->heard.size(); ++i)
        EXPECT_EQ(notes->heard[i], notes->heard[i - 1] + 1);
    EXPECT_EQ(notes->heard.back(), 79);
}

TEST_F(SoundOutputTest, WhatWasLeftOutIsSilentAndMovesNothing) {
    SoundTrack track(25, SoundEncoder::Codec::pcm, true);
    std::vector<float> heard;
    const auto take = [&] {
        while (const AVPacket* packet = track.encoder().next())
            heard.resize(heard.size() + static_cast<std::size_t>(packet->size) / 3);
    };
    track.add(*picture(100).sound, 0);
    track.add(*picture(104).sound, 4);
    track.encoder().end();
    take();
    EXPECT_EQ(heard.size(), 5u * 1920 * sound_channels);
}

/// The streams, by real peers.
class SoundStreamTest : public SoundOutputTest {
  protected:
    /// What FFmpeg takes of a stream in four seconds of it.
    Heard received(const std::string& url, const std::string& from) {
        Output output(plan_output(url, format_), format_, 25);
        output.start();
        std::jthread feeder([&](const std::stop_token& stop) {
            // Twice as fast as it is, which a receiver of UDP has no say in.
            MonotonicTime due = MonotonicClock::now();
            for (std::uint64_t tick = 0; !stop.stop_requested() && tick < 990; ++tick) {
                output.take(picture(tick));
                due += 20ms;
                std::this_thread::sleep_for(due - MonotonicClock::now());
            }
        });
        const ProgramResult result =
            run_to_end("/usr/bin/timeout", {"60", "/usr/bin/ffmpeg", "-v", "error", "-y", "-i",
                                            from, "-c", "copy", "-t", "4", at("received.ts")});
        EXPECT_EQ(result.status, 0) << result.err;
        feeder.request_stop();
        feeder.join();
        output.finish();
        EXPECT_EQ(output.state().silenced, 0u);
        return heard(at("received.ts"));
    }
    /// Somebody who joins hears from some second on.
    static std::vector<std::int64_t> expect_some_clicks(const Heard& heard) {
        EXPECT_EQ(heard.codec, "aac");
        EXPECT_EQ(heard.rate, "48000");
        const std::vector<std::int64_t> found = found_clicks(heard.samples);
        EXPECT_GE(found.size(), 2u);
        return found;
    }
    static void expect_even_clicks(const Heard& heard) {
        const std::vector<std::int64_t> found = expect_some_clicks(heard);
        for (std::size_t i = 1; i < found.size(); ++i)
            EXPECT_NEAR(static_cast<double>(found[i] - found[i - 1]), 48'000, 100);
    }
    int port_ = two_free_ports().first;
};

TEST_F(SoundStreamTest, SrtCarriesIt) {
    expect_even_clicks(received(fmt::format("srt://127.0.0.1:{}?mode=listener&latency=500", port_),
                                fmt::format("srt://127.0.0.1:{}?connect_timeout=30000", port_)));
}

TEST_F(SoundStreamTest, UdpCarriesIt) {
    // On a busy computer it may lose some.
    expect_some_clicks(received(fmt::format("udp://127.0.0.1:{}", port_),
                                fmt::format("udp://127.0.0.1:{}?timeout=30000000", port_)));
}

TEST_F(SoundStreamTest, AStreamThatIsKeptWholeIsInStepWithThePicture) {
    const auto settings = StreamTarget::Settings{
        .url = "file:" + at("stream.ts"),
        .options = {},
        .encoder = stream_encoder(OutputUrl::parse("udp://127.0.0.1:1"), format_),
        .has_sound = true};
    const OutputPatience patience;
    StreamTarget target(settings, patience);
    PictureEncoder encoder("libx264", settings.encoder->settings());
    for (std::uint64_t tick = 0; tick < 110; ++tick) {
        const ProgrammePicture given = picture(tick);
        encoder.add(given.picture, static_cast<std::int64_t>(tick));
        const AVPacket* packet = encoder.next();
        ASSERT_TRUE(packet);
        target.write_encoded({.packet = {packet, [](const AVPacket*) {}}, .tick = tick},
                             static_cast<std::int64_t>(tick));
        target.hear(*given.sound, static_cast<std::int64_t>(tick));
    }
    target.finish();
    const Heard heard = this->heard(at("stream.ts"));
    EXPECT_EQ(heard.codec, "aac");
    expect_clicks(heard, 110, 0.002);
}

}  // namespace
}  // namespace vantage
