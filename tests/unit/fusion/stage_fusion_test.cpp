#include <cstdlib>
#include <numbers>

#include <gtest/gtest.h>

#include "common/gl/egl_context.h"
#include "common/image/image_file.h"
#include "common/virtual_stage/virtual_rig.h"
#include "common/virtual_stage/virtual_stage.h"
#include "host_app/fusion/image_metrics.h"
#include "host_app/fusion/synthesiser.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;

constexpr auto stage_time = 2s;

StageCamera camera_at(double azimuth_deg, int width_px, int height_px) {
    const VirtualRigPlacement placement{.azimuth_rad = azimuth_deg * std::numbers::pi / 180,
                                        .width_px = width_px,
                                        .height_px = height_px};
    const StereoCalibration rig = ideal_virtual_rig(placement);
    return {width_px, height_px, rig.left.K(), rig.world_from_left};
}

/// What an ideal rig knows: the picture of its left camera with exact depth.
DepthView film(VirtualStage& stage, double azimuth_deg, int width_px = 320, int height_px = 240) {
    const StageCamera camera = camera_at(azimuth_deg, width_px, height_px);
    StageRendering seen = stage.render(camera, stage_time);
    return {.name = std::to_string(azimuth_deg),
            .colour = seen.colour,
            .K = camera.K,
            .world_from_camera = camera.world_from_camera,
            .depth_m = seen.depth_m,
            .baseline_m = VirtualRigPlacement{}.baseline_m,
            .doffs_px = 0};
}

struct Score {
    double psnr_db, psnr_covered_db, ssim, coverage;
};

/// Renders the view at an azimuth and compares it with the stage's own picture; both go to
/// $VANTAGE_TEST_PICTURES where that is set, for a person to look at.
Score score(Synthesiser& synthesiser, VirtualStage& stage, double azimuth_deg,
            const std::string& name) {
    const StageCamera camera = camera_at(azimuth_deg, 320, 240);
    const ColourImage truth =
        stage.render(camera, stage_time, {.pictures = StagePictures::colour}).colour;
    const ColourImage picture =
        synthesiser.render({camera.width_px, camera.height_px, camera.K, camera.world_from_camera})
            .download();
    if (const char* folder = std::getenv("VANTAGE_TEST_PICTURES")) {
        const std::filesystem::path path = std::filesystem::path(folder) / name;
        write_colour_image(path.string() + ".png", picture);
        write_colour_image(path.string() + "-true.png", truth);
        write_colour_image(path.string() + "-difference.png", difference_picture(picture, truth));
    }
    return {psnr_db(picture, truth), psnr_db(picture, truth, covered_mask(picture)),
            ssim(picture, truth), coverage(picture)};
}

class StageFusionTest : public testing::TestWithParam<std::string> {
  protected:
    EglContext context_;
    ShaderLibrary shaders_;
    VirtualStage stage_{shaders_};
    std::unique_ptr<Synthesiser> synthesiser_ = make_synthesiser(GetParam(), shaders_);
};

/// Views 15 degrees from the nearest rigs, of a set full of fine texture, gloss and thin rails.
TEST_P(StageFusionTest, MeetsTheStageBetweenFourRigsWithExactDepth) {
    const DepthView views[] = {film(stage_, -45), film(stage_, -15), film(stage_, 15),
                               film(stage_, 45)};
    synthesiser_->set_views(views);
    for (const double azimuth_deg : {0.0, -30.0, 30.0}) {
        const Score s = score(*synthesiser_, stage_, azimuth_deg,
                              GetParam() + "-arc-" + std::to_string(azimuth_deg));
        EXPECT_GE(s.psnr_covered_db, 25) << "at " << azimuth_deg;
        EXPECT_GE(s.ssim, 0.85) << "at " << azimuth_deg;
        EXPECT_GE(s.coverage, 0.9) << "at " << azimuth_deg;
    }
}

TEST_P(StageFusionTest, MeetsTheStageBetweenTwoCloseRigs) {
    const DepthView views[] = {film(stage_, -4), film(stage_, 4)};
    synthesiser_->set_views(views);
    const Score s = score(*synthesiser_, stage_, 0, GetParam() + "-close");
    EXPECT_GE(s.psnr_covered_db, 29);
    EXPECT_GE(s.ssim, 0.9);
    EXPECT_GE(s.coverage, 0.9);
}

INSTANTIATE_TEST_SUITE_P(All, StageFusionTest, testing::Values("mesh", "fused"),
                         [](const auto& test) { return test.param; });

}  // namespace
}  // namespace vantage
