#include "host_app/exports/film_export.h"

#include <fstream>

#include <gtest/gtest.h>

#include "common/image/image_file.h"
#include "host_app/exports/moment.h"
#include "host_app/view_sets/image_metrics.h"
#include "tests/support/child_program.h"
#include "tests/support/data_folder.h"
#include "tests/support/source_folder.h"
#include "tests/support/thrown_sentence.h"
#include "tests/unit/output/probed_film.h"

namespace vantage {
namespace {

/// Of the take of version 1: two rigs of 96x72, 15 pulses, and the camera of as many ticks.
class FilmExport : public testing::Test {
  protected:
    std::filesystem::path path(const std::string& name) const { return folder_.path() / name; }
    FilmSettings settings() const {
        return {{96, 72, {}}, take_->facts().pulse_rate_hz, default_synthesiser};
    }
    ExportBooks film(const std::vector<FilmPicture>& pictures, const std::string& name) const {
        return export_film(take_, pictures, settings(), path(name), [] { return true; });
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

TEST_F(FilmExport, AMoveOverAPartGoesAtNormalSpeedAndStaysWhereItEnds) {
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

TEST_F(FilmExport, AMoveThatLeadsTimeIsAsLongAsItIs) {
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

TEST_F(FilmExport, TheFlightOfTheTakeIsShownTickByTick) {
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

TEST_F(FilmExport, FromARigsPlaceItIsWhatTheRigSaw) {
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

TEST_F(FilmExport, ReplacesNothingAndEndsWhereItIsNotWantedAnyMore) {
    std::vector<FilmPicture> pictures(4, {first(), rigs_camera()});
    int asked = 0;
    const ExportBooks books =
        export_film(take_, pictures, settings(), path("short.mkv"), [&] { return ++asked <= 2; });
    EXPECT_EQ(books.written, 2u);
    EXPECT_EQ(probe_film(path("short.mkv")).times_s.size(), 2u);
    EXPECT_NE(thrown_sentence([&] { film(pictures, "short.mkv"); }).find("already"),
              std::string::npos);
    EXPECT_NE(thrown_sentence([&] {
                  export_film(take_, pictures, settings(), path("none.mkv"), [] { return false; });
              }).find("none.mkv"),
              std::string::npos);
    EXPECT_FALSE(std::filesystem::exists(path("none.mkv")));
}

}  // namespace
}  // namespace vantage
