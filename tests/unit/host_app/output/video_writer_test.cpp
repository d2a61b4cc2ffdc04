#include <cmath>
#include <fstream>
#include <iterator>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "common/base/error.h"
#include "host_app/output/media/film_file.h"
#include "tests/support/data_folder.h"
#include "tests/support/thrown_sentence.h"
#include "tests/unit/host_app/output/files_in.h"
#include "tests/unit/host_app/output/probed_film.h"

namespace vantage {
namespace {

ColourImage grey_picture(int width_px, int height_px, int level) {
    return ColourImage(
        height_px, width_px,
        cv::Vec4b(static_cast<unsigned char>(level), static_cast<unsigned char>(level),
                  static_cast<unsigned char>(level), 255));
}

class VideoWriterTest : public testing::TestWithParam<const char*> {
  protected:
    TemporaryFolder folder_;
    std::filesystem::path path_ = folder_.path() / (std::string("film") + GetParam());
};

TEST_P(VideoWriterTest, KeepsEveryPictureItsTimeAndItsLight) {
    VideoWriter writer(path_, {.width_px = 96, .height_px = 64, .rate_hz = 25});
    for (int i = 0; i < 40; ++i) writer.add(grey_picture(96, 64, 5 * i), i);
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
            writer.add(grey_picture(64, 48, 100), i, i == 0 ? code : "00:00:00:00");
        writer.finish();
        EXPECT_EQ(probe_film(path_).timecode, code);
    }
    VideoWriter writer(path_, {.width_px = 64, .height_px = 48, .rate_hz = 25});
    writer.add(grey_picture(64, 48, 100), 0);
    writer.finish();
    EXPECT_EQ(probe_film(path_).timecode, "");
}

TEST_P(VideoWriterTest, KeepsAGapInTimeAsAGap) {
    VideoWriter writer(path_, {.width_px = 64, .height_px = 48, .rate_hz = 25});
    for (const int tick : {0, 1, 2, 7, 8}) writer.add(grey_picture(64, 48, 100), tick);
    writer.finish();
    const ProbedFilm film = probe_film(path_);
    ASSERT_EQ(film.times_s.size(), 5u);
    EXPECT_NEAR(film.times_s[3], 0.28, 1e-6);
    EXPECT_NEAR(film.times_s[4], 0.32, 1e-6);
}

TEST_P(VideoWriterTest, TellsBroadcastRatesExactly) {
    for (const auto& [rate_hz, rate] : {std::pair(25.0, AVRational{25, 1}),
                                        {29.97, {30000, 1001}},
                                        {30.0, {30, 1}},
                                        {50.0, {50, 1}},
                                        {59.94, {60000, 1001}},
                                        {60.0, {60, 1}}}) {
        VideoWriter writer(path_, {.width_px = 64, .height_px = 48, .rate_hz = rate_hz});
        const std::int64_t pictures = 4 * std::llround(rate_hz);
        for (std::int64_t i = 0; i < pictures; ++i) writer.add(grey_picture(64, 48, 100), i);
        writer.finish();
        const ProbedFilm film = probe_film(path_);
        // Matroska has the length of a picture in whole nanoseconds, and FFmpeg makes fractions of
        // it whose numbers are 30000 at the most.
        if (std::string(GetParam()) == ".mkv" && rate.num > 30000)
            EXPECT_NEAR(av_q2d(film.rate) / av_q2d(rate), 1, 1e-7) << rate_hz;
        else
            EXPECT_EQ(av_cmp_q(film.rate, rate), 0)
                << rate_hz << ": " << film.rate.num << "/" << film.rate.den;
        ASSERT_EQ(film.times_s.size(), static_cast<std::size_t>(pictures));
        // Matroska keeps milliseconds.
        for (std::size_t i = 0; i < film.times_s.size(); ++i)
            ASSERT_NEAR(film.times_s[i], static_cast<double>(i) * rate.den / rate.num, 0.00051);
    }
}

TEST_P(VideoWriterTest, LeavesOutTheOddRowAndColumn) {
    VideoWriter writer(path_, {.width_px = 61, .height_px = 47, .rate_hz = 30});
    writer.add(grey_picture(61, 47, 50), 0);
    writer.finish();
    const ProbedFilm film = probe_film(path_);
    EXPECT_EQ(film.width_px, 60);
    EXPECT_EQ(film.height_px, 46);
}

TEST_P(VideoWriterTest, LeavesTheOldFileWhenItDoesNotFinish) {
    std::ofstream(path_) << "the last take";
    {
        VideoWriter writer(path_, {.width_px = 64, .height_px = 48, .rate_hz = 25});
        writer.add(grey_picture(64, 48, 100), 0);
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

/// A box of so many bytes in all.
std::string box(const std::string& type, std::size_t bytes) {
    return std::string{'\0', '\0', '\0', static_cast<char>(bytes)} + type +
           std::string(bytes - 8, 'x');
}

class Mp4FragmentsTest : public testing::Test {
  protected:
    std::string cut(const std::string& content) {
        const std::filesystem::path path = folder_.path() / "film.mp4";
        std::ofstream(path, std::ios::binary) << content;
        cut_to_whole_fragments(path);
        std::ifstream in(path, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }
    TemporaryFolder folder_;
    const std::string head_ = box("ftyp", 20) + box("moov", 40),
                      fragment_ = box("moof", 16) + box("mdat", 30);
};

TEST_F(Mp4FragmentsTest, KeepsWhatIsWhole) {
    EXPECT_EQ(cut(head_ + fragment_ + fragment_), head_ + fragment_ + fragment_);
    // 64 bits of size where 32 do not do.
    const std::string large = box("moof", 16) + std::string{'\0', '\0', '\0', '\1'} + "mdat" +
                              std::string(7, '\0') + std::string{'\x18'} + "12345678";
    EXPECT_EQ(cut(head_ + large + fragment_), head_ + large + fragment_);
    EXPECT_EQ(cut(head_ + large + "more"), head_ + large);
}

TEST_F(Mp4FragmentsTest, CutsOffHalfAFragmentWhereverItEnds) {
    const std::string whole = head_ + fragment_;
    for (std::size_t bytes = 1; bytes < fragment_.size(); ++bytes)
        EXPECT_EQ(cut(whole + fragment_.substr(0, bytes)), whole) << bytes;
}

TEST_F(Mp4FragmentsTest, LeavesNothingOfWhatIsNoSuchFile) {
    EXPECT_EQ(cut("something else altogether"), "");
    EXPECT_EQ(cut(std::string(40, '\0')), "");
    EXPECT_EQ(cut(""), "");
}

}  // namespace

}  // namespace vantage
