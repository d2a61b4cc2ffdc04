#include "host_app/exports/film_export.h"

#include <csignal>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "common/image/image_file.h"
#include "host_app/exports/film_parts.h"
#include "host_app/exports/moment.h"
#include "host_app/view_sets/image_metrics.h"
#include "tests/support/child_program.h"
#include "tests/support/data_folder.h"
#include "tests/support/source_folder.h"
#include "tests/support/thrown_sentence.h"
#include "tests/unit/host_app/output/probed_film.h"

namespace vantage {
namespace {

/// Of the take of version 1: two rigs of 96x72, 15 pulses, and the camera of as many ticks.
class FilmExport : public testing::Test {
  protected:
    std::filesystem::path path(const std::string& name) const { return folder_.path() / name; }
    FilmSettings settings() const {
        return {{96, 72, {}}, take_->facts().pulse_rate_hz, default_synthesiser, 5};
    }
    ExportStats film(const std::vector<FilmPicture>& pictures, const std::string& name) const {
        return export_film(take_, pictures, settings(), path(name), [] { return true; });
    }
    /// Its first pictures, and no more.
    ExportStats begin_film(const std::vector<FilmPicture>& pictures, const std::string& name,
                           int count) const {
        int begun = 0;
        return export_film(
            take_, pictures, settings(), path(name), [&] { return begun < count; },
            [&](double) { ++begun; });
    }
    /// Past the first rig, pulse by pulse.
    std::vector<FilmPicture> flight(std::size_t count) const {
        std::vector<FilmPicture> pictures(count, {first(), rigs_camera()});
        for (std::size_t i = 0; i < count; ++i) {
            pictures[i].pulse += static_cast<double>(i);
            pictures[i].camera.world_from_camera.translation().x() += 0.01 * static_cast<double>(i);
        }
        return pictures;
    }
    /// A line with a checksum of every coded picture.
    static std::string packets_of(const std::filesystem::path& film) {
        const ProgramResult result =
            run_to_end("/usr/bin/ffmpeg", {"-v", "error", "-i", film.string(), "-map", "0:v", "-c",
                                           "copy", "-f", "framehash", "-"});
        EXPECT_EQ(result.status, 0) << result.err;
        std::istringstream lines(result.out);
        std::string sums;
        for (std::string line; std::getline(lines, line);)
            if (line.front() != '#') sums += line.substr(line.rfind(' ') + 1) + '\n';
        return sums;
    }
    std::vector<ColourImage> pictures_of(const std::string& name) const {
        const std::filesystem::path folder = path(name + ".pictures");
        std::filesystem::create_directory(folder);
        const ProgramResult result =
            run_to_end("/usr/bin/ffmpeg",
                       {"-v", "error", "-i", path(name).string(), (folder / "%03d.png").string()});
        EXPECT_EQ(result.status, 0) << result.err;
        std::vector<ColourImage> pictures;
        while (std::filesystem::exists(folder / fmt::format("{:03}.png", pictures.size() + 1)))
            pictures.push_back(
                read_colour_image(folder / fmt::format("{:03}.png", pictures.size() + 1)));
        std::filesystem::remove_all(folder);
        return pictures;
    }
    void expect_same_film(const std::string& name, const std::string& unbroken) const {
        const ProbedFilm one = probe_film(path(name)), other = probe_film(path(unbroken));
        EXPECT_EQ(one.times_s, other.times_s);
        EXPECT_EQ(one.timecode, other.timecode);
        EXPECT_EQ(av_q2d(one.rate), av_q2d(other.rate));
        EXPECT_EQ(one.duration_s, other.duration_s);
        const std::vector<ColourImage> pictures = pictures_of(name), whole = pictures_of(unbroken);
        ASSERT_EQ(pictures.size(), whole.size());
        // What was learnt before a picture is not all the same.
        for (std::size_t i = 0; i < pictures.size(); ++i)
            EXPECT_GT(psnr_db(pictures[i], whole[i]), 30) << i;
    }
    double rate_hz() const { return take_->facts().pulse_rate_hz; }
    double first() const { return static_cast<double>(take_->frames(0).front().pulse); }
    /// The first rig's camera.
    CameraState rigs_camera() const {
        const Moment moment = MomentReader(*take_).at(take_->frames(0).front().pulse);
        const MomentView& view = moment.views[0];
        CameraState camera;
        camera.world_from_camera = view.world_from_camera;
        camera.field_of_view_rad = 2 * std::atan(0.5 * view.colour.cols / view.K(0, 0));
        return camera;
    }

    TemporaryFolder folder_;
    std::shared_ptr<const TakeReader> take_ =
        std::make_shared<const TakeReader>(source_folder() / "tests" / "takes" / "version_1.mkv");
};

TEST_F(FilmExport, PlaysAPartAtNormalSpeedAndHoldsTheMovesEnd) {
    OrbitView end;
    end.azimuth_rad = 1;
    const Move move({{0, {}, Easing::linear}, {0.2, end, Easing::linear}}, false);
    const auto from = static_cast<std::uint64_t>(first()) + 2;
    const std::vector<FilmPicture> pictures =
        film_of(move, *take_, {from, from + 10, 1}, 2 * rate_hz());
    ASSERT_EQ(pictures.size(), 20u);
    for (std::size_t i = 0; i < pictures.size(); ++i)
        EXPECT_EQ(static_cast<std::uint64_t>(pictures[i].pulse), from + i / 2) << i;
    EXPECT_TRUE(is_same_view(pictures.back().camera, end.camera()));
    EXPECT_FALSE(is_same_view(pictures[1].camera, end.camera()));
}

TEST_F(FilmExport, AMoveWithTimeDeterminesTheLength) {
    const Move move({{0, {}, Easing::linear, 0.4},
                     {2, {}, Easing::linear, 0.4},
                     {2.4, {}, Easing::linear, 0.0}},
                    false);
    const std::vector<FilmPicture> pictures = film_of(move, *take_, {}, rate_hz());
    ASSERT_EQ(pictures.size(), static_cast<std::size_t>(std::round(2.4 * rate_hz())));
    const double frozen = first() + 0.4 * rate_hz();
    EXPECT_NEAR(pictures.front().pulse, frozen, 1e-3);
    EXPECT_NEAR(pictures[pictures.size() / 2].pulse, frozen, 1e-3);
    EXPECT_NEAR(pictures.back().pulse, frozen - 0.2 * rate_hz(), 1e-3) << "backwards";
}

TEST_F(FilmExport, ShowsTheRecordedCameraTickByTick) {
    const std::vector<FilmPicture> pictures = film_of_cameras(*take_, {}, rate_hz());
    ASSERT_NEAR(static_cast<double>(pictures.size()), static_cast<double>(take_->cameras().size()),
                1);
    EXPECT_EQ(static_cast<std::uint64_t>(pictures.front().pulse), take_->cameras().front().pulse);
    EXPECT_TRUE(pictures.front().camera.world_from_camera.isApprox(
        take_->cameras().front().world_from_camera, 1e-6));
    EXPECT_NE(thrown_sentence([&] {
                  (void)film_of_cameras(*take_, {5, 6, 1}, 25);
              }).find("--path"),
              std::string::npos);
}

TEST_F(FilmExport, EqualsTheRigsImageFromItsPose) {
    std::vector<FilmPicture> pictures(6, {first(), rigs_camera()});
    for (std::size_t i = 0; i < pictures.size(); ++i) pictures[i].pulse += static_cast<double>(i);
    EXPECT_EQ(film(pictures, "rig.mkv").written, pictures.size());
    const ProbedFilm probed = probe_film(path("rig.mkv"));
    EXPECT_EQ(probed.times_s.size(), pictures.size());
    EXPECT_EQ(probed.width_px, 96);
    EXPECT_FALSE(probed.timecode.empty());
    // The last picture against the rig's own.
    const ProgramResult still = run_to_end(
        "/usr/bin/ffmpeg", {"-v", "error", "-i", path("rig.mkv").string(), "-vf",
                            "select=eq(n\\,5)", "-frames:v", "1", path("last.png").string()});
    ASSERT_EQ(still.status, 0) << still.err;
    const Moment moment = MomentReader(*take_).at(take_->frames(0)[5].pulse);
    EXPECT_GT(psnr_db(read_colour_image(path("last.png")), moment.views[0].colour), 24);
}

TEST_F(FilmExport, ReplacesNoFile) {
    std::ofstream(path("film.mkv")) << "mine";
    EXPECT_NE(thrown_sentence([&] { film(flight(4), "film.mkv"); }).find("already"),
              std::string::npos);
    EXPECT_EQ(std::filesystem::file_size(path("film.mkv")), 4u);
}

TEST_F(FilmExport, ResumesWithoutReencoding) {
    const std::vector<FilmPicture> pictures = flight(12);
    EXPECT_EQ(begin_film(pictures, "film.mkv", 7).written, 7u);
    EXPECT_FALSE(std::filesystem::exists(path("film.mkv")));
    const std::filesystem::path parts = FilmParts::folder_of(path("film.mkv"));
    std::string coded = packets_of(parts / "00000000.mp4") + packets_of(parts / "00000005.mp4");
    EXPECT_EQ(std::count(coded.begin(), coded.end(), '\n'), 7);
    // Another flight is another film.
    EXPECT_NE(thrown_sentence([&] { film(flight(11), "film.mkv"); }).find("another export"),
              std::string::npos);

    const ExportStats stats = film(pictures, "film.mkv");
    EXPECT_EQ(stats.there, 7u);
    EXPECT_EQ(stats.written, 5u);
    EXPECT_FALSE(std::filesystem::exists(parts));
    EXPECT_EQ(packets_of(path("film.mkv")).substr(0, coded.size()), coded);
    EXPECT_EQ(film(pictures, "unbroken.mkv").written, 12u);
    expect_same_film("film.mkv", "unbroken.mkv");
}

TEST_F(FilmExport, ResumesAKilledExport) {
    const std::vector<FilmPicture> pictures = flight(14);
    const std::filesystem::path parts = FilmParts::folder_of(path("film.mp4"));
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
        film(pictures, "film.mp4");
        _exit(0);
    }
    // In the middle of its second part.
    while (!std::filesystem::exists(parts / "00000000.mp4") &&
           waitpid(child, nullptr, WNOHANG) == 0)
        usleep(1000);
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    ASSERT_FALSE(std::filesystem::exists(path("film.mp4")));
    const ExportStats stats = film(pictures, "film.mp4");
    EXPECT_GE(stats.there, settings().part_pictures);
    EXPECT_EQ(stats.there + stats.written, pictures.size());
    film(pictures, "unbroken.mp4");
    expect_same_film("film.mp4", "unbroken.mp4");
    for (const auto& entry : std::filesystem::directory_iterator(folder_.path()))
        EXPECT_TRUE(entry.is_regular_file() &&
                    entry.path().string().find("partial") == std::string::npos)
            << entry.path();
}

TEST_F(FilmExport, LocksItsPartsAndChecksThem) {
    const std::vector<FilmPicture> pictures = flight(6);
    begin_film(pictures, "film.mkv", 5);
    const std::filesystem::path parts = FilmParts::folder_of(path("film.mkv"));
    {
        const FilmParts held(parts, rate_hz());
        EXPECT_EQ(held.pictures(), 5u);
        EXPECT_NE(
            thrown_sentence([&] { film(pictures, "film.mkv"); }).find("wait until it has ended"),
            std::string::npos);
    }
    std::ofstream(parts / "00000000.mp4") << "damaged";
    const std::string sentence = thrown_sentence([&] { film(pictures, "film.mkv"); });
    EXPECT_NE(sentence.find("00000000.mp4"), std::string::npos) << sentence;
    EXPECT_NE(sentence.find("delete it"), std::string::npos) << sentence;
}

}  // namespace
}  // namespace vantage
