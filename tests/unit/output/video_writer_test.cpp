#include "host_app/output/video_writer.h"

#include <fstream>
#include <thread>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "common/base/error.h"
#include "host_app/output/video_recorder.h"
#include "tests/support/data_folder.h"
#include "tests/support/full_disk.h"
#include "tests/support/thrown_sentence.h"
#include "tests/unit/output/probed_film.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;

ColourImage grey_picture(int width_px, int height_px, int level) {
    return ColourImage(
        height_px, width_px,
        cv::Vec4b(static_cast<unsigned char>(level), static_cast<unsigned char>(level),
                  static_cast<unsigned char>(level), 255));
}

std::size_t files_in(const std::filesystem::path& folder) {
    return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder), {}));
}

class VideoWriterTest : public testing::TestWithParam<const char*> {
  protected:
    TemporaryFolder folder_;
    std::filesystem::path path_ = folder_.path() / (std::string("film") + GetParam());
};

TEST_P(VideoWriterTest, KeepsEveryPictureItsTimeAndItsLight) {
    VideoWriter writer(path_, {.width_px = 96, .height_px = 64, .rate_hz = 25});
    for (int i = 0; i < 40; ++i) writer.add(grey_picture(96, 64, 5 * i), i * 40ms);
    EXPECT_FALSE(std::filesystem::exists(path_)) << "before it is whole";
    writer.finish();
    const ProbedFilm film = probe_film(path_);
    EXPECT_EQ(film.width_px, 96);
    EXPECT_EQ(film.height_px, 64);
    EXPECT_NEAR(film.duration_s, 40 * 0.04, 0.0011);
    ASSERT_EQ(film.times_s.size(), 40u);
    for (std::size_t i = 0; i < 40; ++i) {
        EXPECT_NEAR(film.times_s[i], 0.04 * static_cast<double>(i), 1e-6);
        // Studio range: 16 is black, 235 is white.
        EXPECT_NEAR(film.middle_lumas[i], 16 + 5.0 * static_cast<double>(i) * 219 / 255, 3);
    }
    EXPECT_EQ(files_in(folder_.path()), 1u);
}

TEST_P(VideoWriterTest, CarriesTheTimeCodeOfItsFirstPicture) {
    for (const auto& [rate_hz, code] : {std::pair(25.0, "23:59:59:24"),
                                        {29.97, "10:20:00;02"},
                                        {59.94, "00:00:00;59"},
                                        {14.0, "01:02:03:13"}}) {
        VideoWriter writer(path_, {.width_px = 64, .height_px = 48, .rate_hz = rate_hz});
        for (int i = 0; i < 3; ++i)
            writer.add(grey_picture(64, 48, 100), i * 80ms, i == 0 ? code : "00:00:00:00");
        writer.finish();
        EXPECT_EQ(probe_film(path_).timecode, code);
    }
    VideoWriter writer(path_, {.width_px = 64, .height_px = 48, .rate_hz = 25});
    writer.add(grey_picture(64, 48, 100), 0ms);
    writer.finish();
    EXPECT_EQ(probe_film(path_).timecode, "");
}

TEST_P(VideoWriterTest, KeepsAGapInTimeAsAGap) {
    VideoWriter writer(path_, {.width_px = 64, .height_px = 48, .rate_hz = 25});
    for (const int tick : {0, 1, 2, 7, 8}) writer.add(grey_picture(64, 48, 100), tick * 40ms);
    writer.finish();
    const ProbedFilm film = probe_film(path_);
    ASSERT_EQ(film.times_s.size(), 5u);
    EXPECT_NEAR(film.times_s[3], 0.28, 1e-6);
    EXPECT_NEAR(film.times_s[4], 0.32, 1e-6);
}

TEST_P(VideoWriterTest, LeavesOutTheOddRowAndColumn) {
    VideoWriter writer(path_, {.width_px = 61, .height_px = 47, .rate_hz = 30});
    writer.add(grey_picture(61, 47, 50), 0ns);
    writer.finish();
    const ProbedFilm film = probe_film(path_);
    EXPECT_EQ(film.width_px, 60);
    EXPECT_EQ(film.height_px, 46);
}

TEST_P(VideoWriterTest, LeavesTheOldFileWhenItDoesNotFinish) {
    std::ofstream(path_) << "the last take";
    {
        VideoWriter writer(path_, {.width_px = 64, .height_px = 48, .rate_hz = 25});
        writer.add(grey_picture(64, 48, 100), 0ns);
    }
    EXPECT_EQ(files_in(folder_.path()), 1u);
    std::string text;
    std::getline(std::ifstream(path_), text);
    EXPECT_EQ(text, "the last take");
}

INSTANTIATE_TEST_SUITE_P(Containers, VideoWriterTest, testing::Values(".mkv", ".mp4"));

TEST(VideoWriterRefusal, NamesWhatDoesNotFit) {
    const TemporaryFolder folder;
    const VideoSettings settings{.width_px = 64, .height_px = 48, .rate_hz = 25};
    const auto sentence = [](const std::filesystem::path& path, const VideoSettings& wanted) {
        return thrown_sentence([&] { VideoWriter writer(path, wanted); });
    };
    EXPECT_NE(sentence(folder.path() / "film.avi", settings).find(".mkv"), std::string::npos);
    EXPECT_NE(sentence(folder.path() / "no" / "film.mkv", settings).find("No such file"),
              std::string::npos);
    EXPECT_NE(sentence(folder.path() / "film.mkv", {.width_px = 1, .height_px = 48}).find("1x48"),
              std::string::npos);
    EXPECT_EQ(files_in(folder.path()), 0u);
}

TEST(VideoWriterRefusal, DoesNotWriteAFilmWithoutPictures) {
    const TemporaryFolder folder;
    VideoWriter writer(folder.path() / "film.mkv", {.width_px = 64, .height_px = 48});
    EXPECT_THROW(writer.finish(), Error);
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "film.mkv"));
}

TEST(VideoRecorder, AccountsForEveryPicture) {
    const TemporaryFolder folder;
    const std::filesystem::path path = folder.path() / "film.mkv";
    VideoRecorder recorder(path, {.width_px = 320, .height_px = 240, .rate_hz = 100});
    for (int i = 0; i < 60; ++i) recorder.add(grey_picture(320, 240, i), i * 10ms);
    recorder.finish();
    EXPECT_EQ(recorder.frames() + recorder.dropped(), 60u);
    EXPECT_GE(recorder.frames(), 8u) << "what waits at the end is written";
    const ProbedFilm film = probe_film(path);
    EXPECT_EQ(film.times_s.size(), recorder.frames());
    EXPECT_NEAR(film.times_s.back(), 0.59, 0.0011) << "the newest picture is never the one dropped";
}

class FullDiskTest : public testing::TestWithParam<const char*> {
  protected:
    /// Pictures that compress badly, until the recorder says that it has failed; its sentence.
    std::string record_until_it_fails() {
        VideoRecorder recorder(path_, {.width_px = 160, .height_px = 120, .rate_hz = 25});
        cv::RNG random(1);
        ColourImage noise(120, 160);
        return thrown_sentence([&] {
            for (int i = 0; i < 250; ++i) {
                random.fill(noise, cv::RNG::UNIFORM, 0, 256);
                recorder.add(noise.clone(), i * 40ms);
                std::this_thread::sleep_for(2ms);
            }
            recorder.finish();
        });
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
    std::string text;
    std::getline(std::ifstream(path_), text);
    EXPECT_EQ(text, "the last take");
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

TEST(VideoRecorder, LeavesNoFileBehindWhenAbandoned) {
    const TemporaryFolder folder;
    {
        VideoRecorder recorder(folder.path() / "film.mkv", {.width_px = 64, .height_px = 48});
        recorder.add(grey_picture(64, 48, 3), 0ns);
    }
    EXPECT_EQ(files_in(folder.path()), 0u);
}

}  // namespace
}  // namespace vantage
