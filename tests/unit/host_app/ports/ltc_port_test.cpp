#include "common/av/sound.h"
#include "common/base/time/kernel_clock.h"
#include "common/base/time/timecode.h"
#include "host_app/ltc/ltc_writer.h"
#include "tests/support/clicks.h"
#include "tests/support/data_folder.h"
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

TEST_F(LtcPortTest, WhatIsNotThereIsNamed) {
    EXPECT_NE(thrown_sentence([&] {
                  open_port("ltc://" + at("missing.wav"), bench_);
              }).find("missing.wav"),
              std::string::npos);
}

}  // namespace
}  // namespace vantage
