#include "host_app/output/film_sink.h"

#include <gtest/gtest.h>

#include "common/base/time_zone.h"
#include "tests/support/data_folder.h"
#include "tests/unit/output/probed_film.h"

namespace vantage {
namespace {

/// 2026-10-02T12:34:56Z, in seconds of UTC.
constexpr std::int64_t noon_s = 1'790'944'496;
constexpr int tai_offset_s = 37;

class FilmSinkTest : public testing::Test {
  protected:
    FilmSinkTest() { use_time_zone("UTC"); }
    ~FilmSinkTest() override { use_time_zone("UTC"); }

    /// The time code of a film whose first picture shows the instant so long after noon_s.
    std::string timecode_of_film(double rate_hz, double pulse_rate_hz,
                                 std::chrono::nanoseconds after) const {
        const std::filesystem::path path = folder_.path() / "film.mp4";
        FilmSink sink(path, {.width_px = 64, .height_px = 48, .rate_hz = rate_hz}, pulse_rate_hz);
        const PulseGrid pulses(pulse_rate_hz);
        const std::uint64_t first =
            pulses.nearest_index(TaiTime(std::chrono::seconds(noon_s + tai_offset_s) + after));
        for (std::uint64_t tick = 0; tick < 3; ++tick) {
            auto frame = std::make_shared<RigFrame>();
            frame->sync.tai_offset_s = tai_offset_s;
            auto set = std::make_shared<FrameSet>();
            set->trigger_index = first + tick;
            set->slots = {{"gone", nullptr, Absence::disconnected}, {"north", frame}};
            ProgrammePicture picture;
            picture.tick = tick;
            picture.picture = ColourImage(48, 64, cv::Vec4b(90, 90, 90, 255));
            picture.set = set;
            sink.take(picture);
        }
        sink.finish();
        return probe_film(path).timecode;
    }

    TemporaryFolder folder_;
};

TEST_F(FilmSinkTest, TheFilmCarriesTheHousesTimeOfDay) {
    using std::chrono::milliseconds;
    EXPECT_EQ(timecode_of_film(25, 25, milliseconds(480)), "12:34:56:12");
    use_time_zone("Europe/Stockholm");
    EXPECT_EQ(timecode_of_film(25, 25, milliseconds(480)), "14:34:56:12");
    // Counted by the film's frames, whatever the rate of the pulses.
    EXPECT_EQ(timecode_of_film(50, 25, milliseconds(480)), "14:34:56:24");
    EXPECT_EQ(timecode_of_film(25, 5, milliseconds(400)), "14:34:56:10");
}

TEST_F(FilmSinkTest, TheTimeCodeIsDropFrameAtBroadcastRates) {
    const double rate_hz = 29.97;
    const PulseGrid pulses(rate_hz);
    const TaiTime shown =
        pulses.time_of(pulses.nearest_index(TaiTime(std::chrono::seconds(noon_s + tai_offset_s))));
    const std::string code = timecode_of_film(rate_hz, rate_hz, {});
    EXPECT_EQ(code, TimecodeClock(rate_hz).at(shown, tai_offset_s));
    EXPECT_EQ(code[8], ';');
}

TEST_F(FilmSinkTest, NoTimeCodeIsBetterThanOneThatReadersMistake) {
    EXPECT_EQ(timecode_of_film(100, 100, {}), "");
}

}  // namespace
}  // namespace vantage
