#include <fmt/format.h>
#include <ltc.h>

#include "common/av/sound.h"
#include "common/base/time/kernel_clock.h"
#include "common/base/time/timecode.h"
#include "host_app/ltc/ltc_sound.h"
#include "tests/support/clicks.h"
#include "tests/support/data_folder.h"
#include "tests/support/eventually.h"
#include "tests/support/thrown_sentence.h"
#include "tests/unit/host_app/ports/bench_test.h"

namespace vantage {
namespace {

class LtcPortTest : public BenchTest {
  protected:
    std::string at(const std::string& name) const { return (folder_.path() / name).string(); }
    /// So many frames of 25 a second.
    void write(const std::string& name, std::int64_t from, int frames) const {
        LtcWriter writer(25);
        std::vector<float> samples;
        for (int i = 0; i < frames; ++i)
            for (const float sample : writer.frame(SmpteCount{25}.code_of(from + i)))
                samples.insert(samples.end(), 2, sample);
        write_wav(at(name), samples);
    }
    TemporaryFolder folder_;
};

TEST_F(LtcPortTest, AFileIsHeardAndComparedWithTheHouse) {
    // An hour ahead of now, and some frames that nobody can tell beforehand.
    const SmpteCount pal{25};
    const auto house =
        SmpteCode::parse(TimecodeClock(25).at(TaiClock::now(), read_kernel_clock().tai_offset_s));
    const std::int64_t hour = 90'000;
    write("house.wav", *pal.frame_of(*house) + hour, 60);
    const auto port = open_port("ltc://" + at("house.wav"), bench_);
    serve(*port, 20);
    EXPECT_GE(port->stats().obeyed, 20u);
    EXPECT_EQ(port->stats().malformed, 0u);
    const LtcBoard::State state = ltc_.state();
    ASSERT_NE(state.code, "");
    // The file begins when it is opened, some time after it was written.
    EXPECT_LE(state.frames_ahead, hour);
    EXPECT_GT(state.frames_ahead, hour - 25 * 60);
    EXPECT_NE(port->stats().told.find("ahead of the house"), std::string::npos)
        << port->stats().told;
}

TEST_F(LtcPortTest, WhatIsNoTimeCodeIsNeverShown) {
    write_wav(at("clicks.wav"), clicks(1.1));
    const auto port = open_port("ltc:" + at("clicks.wav"), bench_);
    for (int i = 0; i < 40; ++i) port->serve(std::chrono::milliseconds(20));
    EXPECT_EQ(port->stats().obeyed, 0u);
    EXPECT_EQ(ltc_.state().code, "");
}

/// Records two seconds of time code at any sound rate in one channel of two.
void write_ltc(const std::string& path, int rate_hz, std::size_t channel) {
    LTCEncoder* const encoder = ltc_encoder_create(rate_hz, 25, LTC_TV_625_50, 0);
    SMPTETimecode start{"+0000", 0, 0, 0, 10, 11, 12, 0};
    ltc_encoder_set_timecode(encoder, &start);
    std::vector<float> samples;
    for (int frame = 0; frame < 50; ++frame) {
        ltc_encoder_encode_frame(encoder);
        ltc_encoder_inc_timecode(encoder);
        ltcsnd_sample_t* bytes = nullptr;
        const int count = ltc_encoder_get_bufferptr(encoder, &bytes, 1);
        for (int i = 0; i < count; ++i)
            for (std::size_t each = 0; each < sound_channels; ++each)
                samples.push_back(each == channel ? (static_cast<float>(bytes[i]) - 128) / 256 : 0);
    }
    ltc_encoder_free(encoder);
    write_wav(path, samples, rate_hz);
}

TEST_F(LtcPortTest, AFileMayHaveAnySoundRateAndTheCodeInAnyChannel) {
    for (const int rate_hz : {22050, 44100, 96000})
        for (const std::size_t channel : {0, 1}) {
            write_ltc(at("code.wav"), rate_hz, channel);
            testing::internal::CaptureStderr();
            const auto port = open_port("ltc://" + at("code.wav"), bench_);
            serve(*port, 20);
            const std::string log = testing::internal::GetCapturedStderr();
            EXPECT_NE(log.find(fmt::format("channel {} of 2, at {} Hz", channel + 1, rate_hz)),
                      std::string::npos)
                << log;
            EXPECT_TRUE(ltc_.state().code.starts_with("10:11:1")) << ltc_.state().code;
        }
}

TEST_F(LtcPortTest, TheChannelCanBeChosenAndSilenceIsNamed) {
    write_ltc(at("code.wav"), 44100, 0);
    EXPECT_NE(thrown_sentence([&] {
                  open_port("ltc://" + at("code.wav") + "?channels=3", bench_);
              }).find("no channel 3"),
              std::string::npos);
    const auto port = open_port("ltc://" + at("code.wav") + "?channels=2", bench_);
    ASSERT_TRUE(eventually([&] {
        port->serve(std::chrono::milliseconds(20));
        return !port->stats().told.empty();
    }));
    EXPECT_EQ(port->stats().told, "no time code heard in the whole file: channel 2 is silent");
    EXPECT_EQ(port->stats().obeyed, 0u);
}

TEST_F(LtcPortTest, WhatIsNotThereIsNamed) {
    EXPECT_NE(thrown_sentence([&] {
                  open_port("ltc://" + at("missing.wav"), bench_);
              }).find("missing.wav"),
              std::string::npos);
}

}  // namespace
}  // namespace vantage
