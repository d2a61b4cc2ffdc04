#include <fstream>

#include <gtest/gtest.h>

#include "common/base/time/time_zone.h"
#include "host_app/output/output_supervisor.h"
#include "tests/support/data_folder.h"
#include "tests/support/full_disk.h"
#include "tests/unit/host_app/output/files_in.h"
#include "tests/unit/host_app/output/given_pictures.h"
#include "tests/unit/host_app/output/probed_film.h"

namespace vantage {
namespace {

/// 2026-10-02T12:34:56Z, in seconds of UTC.
constexpr std::int64_t noon_s = 1'790'944'496;
constexpr int tai_offset_s = 37;

std::string content_of(const std::filesystem::path& path) {
    std::string text;
    std::getline(std::ifstream(path), text);
    return text;
}

class FilmOutputTest : public testing::Test {
  protected:
    FilmOutputTest() { use_time_zone("UTC"); }
    ~FilmOutputTest() override { use_time_zone("UTC"); }

    OutputFormat format(double rate_hz = 25, bool overwrites = false) const {
        return {.width_px = 64, .height_px = 48, .rate_hz = rate_hz, .overwrites = overwrites};
    }
    std::string at(const std::string& name) const { return (folder_.path() / name).string(); }
    /// None is left out.
    static void give(Output& output, std::uint64_t from, std::uint64_t count) {
        for (std::uint64_t i = 0; i < count; ++i) {
            ASSERT_TRUE(wait_for([&] { return output.state().queued < 8; }));
            output.take(given_picture(from + i));
        }
    }

    /// The time code of a film whose first picture shows the instant so long after noon_s.
    std::string timecode_of_film(double rate_hz, double pulse_rate_hz,
                                 std::chrono::nanoseconds after) const {
        const std::string path = at("film.mp4");
        Output output(plan_output(path, format(rate_hz, true)), format(rate_hz, true),
                      pulse_rate_hz);
        output.start();
        const PulseGrid pulses(pulse_rate_hz);
        const std::uint64_t first =
            pulses.nearest_index(TaiTime(std::chrono::seconds(noon_s + tai_offset_s) + after));
        for (std::uint64_t tick = 0; tick < 3; ++tick) {
            auto frame = std::make_shared<RigFrame>();
            frame->sync.tai_offset_s = tai_offset_s;
            auto set = std::make_shared<FrameSet>();
            set->trigger_index = first + tick;
            set->slots = {{"gone", nullptr, Absence::disconnected}, {"north", frame}};
            ProgrammePicture picture = given_picture(tick);
            picture.set = set;
            output.take(picture);
        }
        output.finish();
        return probe_film(path).timecode;
    }

    TemporaryFolder folder_;
};

TEST_F(FilmOutputTest, CarriesTheHousesTimeOfDay) {
    using std::chrono::milliseconds;
    EXPECT_EQ(timecode_of_film(25, 25, milliseconds(480)), "12:34:56:12");
    use_time_zone("Europe/Stockholm");
    EXPECT_EQ(timecode_of_film(25, 25, milliseconds(480)), "14:34:56:12");
    // Counted by the film's frames, whatever the rate of the pulses.
    EXPECT_EQ(timecode_of_film(50, 25, milliseconds(480)), "14:34:56:24");
    EXPECT_EQ(timecode_of_film(25, 5, milliseconds(400)), "14:34:56:10");
}

TEST_F(FilmOutputTest, TheTimeCodeIsDropFrameAtBroadcastRates) {
    const double rate_hz = 29.97;
    const PulseGrid pulses(rate_hz);
    const TaiTime shown =
        pulses.time_of(pulses.nearest_index(TaiTime(std::chrono::seconds(noon_s + tai_offset_s))));
    const std::string code = timecode_of_film(rate_hz, rate_hz, {});
    EXPECT_EQ(code, TimecodeClock(rate_hz).at(shown, tai_offset_s));
    EXPECT_EQ(code[8], ';');
}

TEST_F(FilmOutputTest, NoTimeCodeIsBetterThanOneThatReadersMistake) {
    EXPECT_EQ(timecode_of_film(100, 100, {}), "");
}

TEST_F(FilmOutputTest, ComesInSegmentsThatLackNoPicture) {
    Output output(plan_output(at("film.mkv?segment=1s"), format()), format(), 25);
    output.start();
    give(output, 0, 60);
    output.finish();
    EXPECT_EQ(output.state().failure, "");
    EXPECT_EQ(output.state().pictures, 60u);
    EXPECT_EQ(files_in(folder_.path()), 3u);
    EXPECT_EQ(probe_film(at("film-001.mkv")).times_s.size(), 25u);
    EXPECT_EQ(probe_film(at("film-002.mkv")).times_s.size(), 25u);
    const ProbedFilm last = probe_film(at("film-003.mkv"));
    ASSERT_EQ(last.times_s.size(), 10u);
    EXPECT_EQ(last.times_s.front(), 0);
}

TEST_F(FilmOutputTest, ComesInSegmentsOfASize) {
    const OutputFormat large{.width_px = 320, .height_px = 240, .rate_hz = 25};
    Output output(plan_output(at("film.mkv?segment=1MB&bitrate=100M"), large), large, 25);
    output.start();
    cv::RNG random(1);
    for (std::uint64_t tick = 0; tick < 120; ++tick) {
        ProgrammePicture picture = given_picture(tick, 0, 320, 240);
        random.fill(picture.picture, cv::RNG::UNIFORM, 0, 256);
        ASSERT_TRUE(wait_for([&] { return output.state().queued < 8; }));
        output.take(picture);
    }
    output.finish();
    std::size_t pictures = 0;
    int part = 1;
    for (; std::filesystem::exists(at(fmt::format("film-{:03}.mkv", part))); ++part) {
        const std::string path = at(fmt::format("film-{:03}.mkv", part));
        pictures += probe_film(path).times_s.size();
        // A segment ends with what its muxer and encoder held back: two seconds at the most.
        EXPECT_LT(std::filesystem::file_size(path), 12'000'000u);
    }
    EXPECT_GE(part - 1, 2);
    EXPECT_EQ(pictures, 120u);
}

TEST_F(FilmOutputTest, ReplacesNothingWhenItIsBegunAgain) {
    std::ofstream(at("film.mkv")) << "of yesterday";
    Output output(plan_output(at("film.mkv"), format(25, true)), format(25, true), 25);
    for (const std::uint64_t begin : {0, 10, 20}) {
        output.start();
        give(output, begin, 4 + begin / 10);
        output.stop();
        ASSERT_TRUE(wait_for([&] { return output.state().phase == OutputPhase::off; }));
    }
    EXPECT_EQ(files_in(folder_.path()), 3u);
    EXPECT_EQ(probe_film(at("film.mkv")).times_s.size(), 4u);
    EXPECT_EQ(probe_film(at("film-2.mkv")).times_s.size(), 5u);
    EXPECT_EQ(probe_film(at("film-3.mkv")).times_s.size(), 6u);
}

TEST_F(FilmOutputTest, LeavesNoFileBehindWhenAbandoned) {
    {
        Output output(plan_output(at("film.mkv"), format()), format(), 25);
        output.start();
        give(output, 0, 3);
    }
    EXPECT_EQ(files_in(folder_.path()), 0u);
}

TEST_F(FilmOutputTest, OpensAsAnEndOfTheProgramLeavesIt) {
    for (const char* name : {"film.mkv", "film.mp4"}) {
        Output output(plan_output(at(name), format()), format(), 25);
        output.start();
        give(output, 0, 200);
        ASSERT_TRUE(wait_for([&] { return output.state().pictures == 200; }));
        // What a kill leaves of it is what is in the file now.
        std::filesystem::path left;
        for (const auto& entry : std::filesystem::directory_iterator(folder_.path()))
            if (entry.path().string().find(".partial-") != std::string::npos) left = entry.path();
        const std::string copy = at(std::string("left-") + name);
        std::filesystem::copy_file(left, copy);
        EXPECT_GE(probe_film(copy).times_s.size(), 200u - 2 * 25 - 25) << name;
        output.finish();
    }
}

TEST_F(FilmOutputTest, AFilmWithoutAPictureHasFailed) {
    Output output(plan_output(at("film.mkv"), format()), format(), 25);
    output.start();
    output.finish();
    EXPECT_NE(output.state().failure.find("no picture"), std::string::npos)
        << output.state().failure;
    EXPECT_EQ(files_in(folder_.path()), 0u);
}

class FullDiskTest : public testing::TestWithParam<const char*> {
  protected:
    /// Pictures that compress badly, until the output says that it has failed; its sentence.
    std::string record_until_it_fails() {
        const OutputFormat format{
            .width_px = 160, .height_px = 120, .rate_hz = 25, .overwrites = true};
        Output output(plan_output(path_.string(), format), format, 25);
        output.start();
        cv::RNG random(1);
        for (std::uint64_t tick = 0; tick < 250; ++tick) {
            ProgrammePicture picture = given_picture(tick, 0, 160, 120);
            random.fill(picture.picture, cv::RNG::UNIFORM, 0, 256);
            output.take(picture);
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
        }
        output.finish();
        return output.state().failure;
    }

    TemporaryFolder folder_;
    std::filesystem::path path_ = folder_.path() / (std::string("film") + GetParam());
};

TEST_P(FullDiskTest, LeavesTheOldFileWhereNothingCanBeRead) {
    std::ofstream(path_) << "the last take";
    std::string sentence;
    {
        const FullDisk disk(200);
        sentence = record_until_it_fails();
    }
    EXPECT_NE(sentence.find(path_.string()), std::string::npos) << sentence;
    EXPECT_NE(sentence.find("File too large"), std::string::npos) << sentence;
    EXPECT_NE(sentence.find("nothing of it can be read"), std::string::npos) << sentence;
    EXPECT_EQ(files_in(folder_.path()), 1u);
    EXPECT_EQ(content_of(path_), "the last take");
}

TEST_P(FullDiskTest, LeavesWhatWasWrittenReadableAndSaysSo) {
    std::ofstream(path_) << "the last take";
    std::string sentence;
    {
        const FullDisk disk(1'000'000);
        sentence = record_until_it_fails();
    }
    EXPECT_NE(sentence.find("File too large"), std::string::npos) << sentence;
    EXPECT_NE(sentence.find("what was written until then is kept"), std::string::npos) << sentence;
    EXPECT_EQ(files_in(folder_.path()), 1u);
    const ProbedFilm film = probe_film(path_);
    EXPECT_EQ(film.width_px, 160);
    EXPECT_GE(film.times_s.size(), 5u);
}

INSTANTIATE_TEST_SUITE_P(Containers, FullDiskTest, testing::Values(".mkv", ".mp4"));

}  // namespace
}  // namespace vantage
