#include <fstream>

#include <gtest/gtest.h>

#include "common/base/time/time_zone.h"
#include "host_app/ltc/ltc_sound.h"
#include "host_app/output/output_supervisor.h"
#include "tests/support/data_folder.h"
#include "tests/support/thrown_sentence.h"
#include "tests/unit/host_app/output/given_pictures.h"

namespace vantage {
namespace {

/// 2026-10-02T12:34:56Z on a clock that nobody told of TAI.
constexpr std::int64_t ltc_begin_s = 1'790'944'496;

class LtcOutputTest : public testing::Test {
  protected:
    LtcOutputTest() { use_time_zone("UTC"); }
    std::string at(const std::string& name) const { return (folder_.path() / name).string(); }

    static ProgrammePicture picture_of(std::uint64_t tick, std::uint64_t pulse) {
        auto set = std::make_shared<FrameSet>();
        set->trigger_index = pulse;
        set->slots = {{"north", std::make_shared<RigFrame>()}};
        ProgrammePicture picture = given_picture(tick);
        picture.set = set;
        return picture;
    }
    /// A programme whose pictures are of pulses of 25 Hz.
    void play(const std::string& url, double rate_hz, std::uint64_t ticks) const {
        const OutputFormat format{.width_px = 64, .height_px = 48, .rate_hz = rate_hz};
        Output output(plan_output(url, format), format, 25);
        output.start();
        // What nobody takes yet is not waited with by a device.
        ASSERT_TRUE(wait_for([&] { return output.state().phase == OutputPhase::on; }));
        const std::uint64_t first =
            PulseGrid(25).nearest_index(TaiTime(std::chrono::seconds(ltc_begin_s)));
        for (std::uint64_t tick = 0; tick < ticks; ++tick) {
            ASSERT_TRUE(wait_for([&] { return output.state().queued < 8; }));
            const auto pulse = static_cast<std::uint64_t>(static_cast<double>(tick) * 25 / rate_hz);
            output.take(picture_of(tick, first + pulse));
        }
        output.finish();
        EXPECT_EQ(output.state().failure, "");
        EXPECT_EQ(output.state().dropped, 0u);
    }
    std::vector<LtcReading> readings_of(const std::string& file, std::size_t channels = 1) const {
        constexpr std::size_t head_bytes = 44;
        std::ifstream in(file, std::ios::binary);
        std::vector<char> bytes((std::istreambuf_iterator<char>(in)), {});
        SoundBlock block;
        // libavformat writes some facts before the samples: they are looked for.
        const std::string_view text(bytes.data(), bytes.size());
        const std::size_t data = text.find("data");
        EXPECT_NE(data, std::string_view::npos);
        for (std::size_t i = std::max(head_bytes, data + 8); i + 1 < bytes.size();
             i += 2 * channels) {
            const auto value =
                static_cast<std::int16_t>(static_cast<unsigned char>(bytes[i]) |
                                          static_cast<unsigned char>(bytes[i + 1]) << 8);
            block.samples.insert(block.samples.end(), 2, static_cast<float>(value) / 32768);
        }
        samples_ = block.count();
        return LtcReader().hear(block);
    }
    TemporaryFolder folder_;
    mutable std::int64_t samples_ = 0;
};

TEST_F(LtcOutputTest, EveryPictureOf25HzHasItsCode) {
    play("ltc:" + at("code.wav"), 25, 100);
    const std::vector<LtcReading> readings = readings_of(at("code.wav"));
    EXPECT_EQ(samples_, 100 * 1920);
    ASSERT_GE(readings.size(), 95u);
    for (const LtcReading& reading : readings) {
        const auto frame = static_cast<int>((reading.first + 960) / 1920);
        EXPECT_EQ(reading.code.text(),
                  fmt::format("12:34:{:02}:{:02}", 56 + frame / 25, frame % 25));
    }
}

TEST_F(LtcOutputTest, At50HzEveryOtherTickBeginsACode) {
    play("ltc:" + at("code.wav"), 50, 200);
    const std::vector<LtcReading> readings = readings_of(at("code.wav"));
    EXPECT_EQ(samples_, 100 * 1920);
    ASSERT_GE(readings.size(), 95u);
    EXPECT_EQ(readings[10].code.text(),
              fmt::format("12:34:56:{:02}", (readings[10].first + 960) / 1920));
}

TEST_F(LtcOutputTest, At2997ItIsDropFrameCode) {
    for (const double rate_hz : {29.97, 59.94}) {
        const std::string file = at(fmt::format("code-{}.wav", rate_hz));
        play("ltc:" + file, rate_hz, rate_hz > 30 ? 240 : 120);
        const std::vector<LtcReading> readings = readings_of(file);
        ASSERT_GE(readings.size(), 110u);
        EXPECT_TRUE(readings.front().code.is_drop_frame);
        EXPECT_EQ(readings.front().code.hours, 12);
        EXPECT_NEAR(static_cast<double>(samples_), 120 * 1601.6, 1602);
    }
}

TEST_F(LtcOutputTest, WhatCannotBeIsSaid) {
    const auto sentence = [&](const std::string& url, double rate_hz) {
        return thrown_sentence([&] { plan_output(url, {.rate_hz = rate_hz}); });
    };
    EXPECT_NE(sentence("ltc:" + at("code.wav"), 15).find("59.94"), std::string::npos);
    EXPECT_NE(sentence("ltc:" + at("code.mp3"), 25).find(".wav"), std::string::npos);
    EXPECT_NE(sentence("ltc:" + at("code.wav") + "?loud=yes", 25).find("no options"),
              std::string::npos);
}

TEST_F(LtcOutputTest, GoesToADeviceAndOneThatIsMissingIsTriedAgain) {
    std::ofstream(at("asoundrc")) << "pcm.heard {\n  type file\n  slave.pcm { type null }\n  file "
                                  << at("heard.wav") << "\n  format wav\n}\n";
    setenv("ALSA_CONFIG_PATH", at("asoundrc").c_str(), 1);
    play("ltc:alsa:heard", 25, 100);
    const OutputFormat format{.rate_hz = 25};
    Output missing(plan_output("ltc:alsa:no_such_device", format), format, 25);
    missing.start();
    EXPECT_TRUE(wait_for([&] { return missing.state().phase == OutputPhase::failed; }));
    EXPECT_NE(missing.state().failure.find("no_such_device"), std::string::npos);
    missing.finish();
    unsetenv("ALSA_CONFIG_PATH");
    const std::vector<LtcReading> readings = readings_of(at("heard.wav"), 2);
    ASSERT_GE(readings.size(), 90u);
    for (std::size_t i = 1; i < readings.size(); ++i)
        EXPECT_EQ(SmpteCount{25}.between(*SmpteCount{25}.frame_of(readings[i].code),
                                         *SmpteCount{25}.frame_of(readings[i - 1].code)),
                  1);
}

}  // namespace
}  // namespace vantage
