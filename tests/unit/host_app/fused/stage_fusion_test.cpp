#include <array>
#include <cmath>
#include <cstdlib>
#include <map>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "common/gl/context/egl_context.h"
#include "common/image/image_file.h"
#include "common/virtual_stage/virtual_rig.h"
#include "common/virtual_stage/virtual_stage.h"
#include "host_app/surfaces/rig_history.h"
#include "host_app/synthesis/synthesiser.h"
#include "host_app/view_sets/image_metrics.h"
#include "tests/support/deviation_along_time.h"
#include "tests/support/stage_camera_at.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;

DepthView film(VirtualStage& stage, double azimuth_deg, int width_px = 320, int height_px = 240,
               std::chrono::nanoseconds time = stage_time) {
    return exact_view_at(stage, azimuth_deg, width_px, height_px, time);
}

struct Score {
    double psnr_db, psnr_covered_db, ssim, coverage;
};

/// Renders the view at an azimuth and compares it with the stage's own picture; both go to
/// $VANTAGE_TEST_PICTURES where that is set, for a person to look at.
Score score(Synthesiser& synthesiser, VirtualStage& stage, double azimuth_deg,
            const std::string& name, int width_px = 320, int height_px = 240,
            std::chrono::nanoseconds time = stage_time) {
    const StageCamera camera = camera_at(azimuth_deg, width_px, height_px);
    const ColourImage truth =
        stage.render(camera, time, {.pictures = StagePictures::colour}).colour;
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

/// What a synthesiser reaches on the stage, with half a decibel to spare.
struct Reached {
    const char* synthesiser;
    double arc_db, arc_ssim, close_db, close_ssim;
};
void PrintTo(const Reached& reached, std::ostream* out) { *out << reached.synthesiser; }

class StageFusionTest : public testing::TestWithParam<Reached> {
  protected:
    EglContext context_;
    ShaderLibrary shaders_;
    VirtualStage stage_{shaders_};
    std::unique_ptr<Synthesiser> synthesiser_ = make_synthesiser(GetParam().synthesiser, shaders_);
};

/// Views 15 degrees from the nearest rigs, of a background full of fine texture, gloss and thin
/// rails.
TEST_P(StageFusionTest, MeetsTheStageBetweenFourRigsWithExactDepth) {
    const DepthView views[] = {film(stage_, -45), film(stage_, -15), film(stage_, 15),
                               film(stage_, 45)};
    synthesiser_->set_views(views);
    for (const double azimuth_deg : {0.0, -30.0, 30.0}) {
        const Score s =
            score(*synthesiser_, stage_, azimuth_deg,
                  std::string(GetParam().synthesiser) + "-arc-" + std::to_string(azimuth_deg));
        EXPECT_GE(s.psnr_covered_db, GetParam().arc_db) << "at " << azimuth_deg;
        EXPECT_GE(s.ssim, GetParam().arc_ssim) << "at " << azimuth_deg;
        EXPECT_GE(s.coverage, 0.9) << "at " << azimuth_deg;
    }
}

TEST_P(StageFusionTest, MeetsTheStageBetweenTwoCloseRigs) {
    const DepthView views[] = {film(stage_, -4), film(stage_, 4)};
    synthesiser_->set_views(views);
    const Score s = score(*synthesiser_, stage_, 0, std::string(GetParam().synthesiser) + "-close");
    EXPECT_GE(s.psnr_covered_db, GetParam().close_db);
    EXPECT_GE(s.ssim, GetParam().close_ssim);
    EXPECT_GE(s.coverage, 0.9);
}

INSTANTIATE_TEST_SUITE_P(All, StageFusionTest,
                         testing::Values(Reached{"mesh", 25, 0.85, 29, 0.9},
                                         Reached{"points", 21, 0.7, 23, 0.8},
                                         Reached{"layered", 25.7, 0.86, 29, 0.9},
                                         Reached{"fused", 27.3, 0.9, 30, 0.93}),
                         [](const auto& test) { return std::string(test.param.synthesiser); });

/// How a stage is meant to be filmed: rigs 20 degrees apart, pictures of television's old size.
TEST(FusedStage, IsWithinThirtyDecibelsBetweenRigsTwentyDegreesApart) {
    const EglContext context;
    const ShaderLibrary shaders;
    VirtualStage stage(shaders);
    const auto synthesiser = make_synthesiser("fused", shaders);
    const DepthView views[] = {film(stage, -30, 640, 480), film(stage, -10, 640, 480),
                               film(stage, 10, 640, 480), film(stage, 30, 640, 480)};
    synthesiser->set_views(views);
    for (const double azimuth_deg : {0.0, -20.0, 20.0}) {
        const Score s = score(*synthesiser, stage, azimuth_deg,
                              "fused-close-arc-" + std::to_string(azimuth_deg), 640, 480);
        EXPECT_GE(s.psnr_covered_db, 30) << "at " << azimuth_deg;
        EXPECT_GE(s.ssim, 0.93) << "at " << azimuth_deg;
        EXPECT_GE(s.coverage, 0.92) << "at " << azimuth_deg;
    }
}

/// Four rigs twenty degrees apart; their depth is exact.
std::vector<DepthView> film_arc(VirtualStage& stage, int width_px, int height_px,
                                std::chrono::nanoseconds time = stage_time) {
    std::vector<DepthView> views;
    for (const double azimuth_deg : {-30, -10, 10, 30})
        views.push_back(film(stage, azimuth_deg, width_px, height_px, time));
    return views;
}

/// The picture midway between rigs twenty degrees apart, against the stage's own.
double midway_psnr_db(VirtualStage& stage, const ShaderLibrary& shaders,
                      std::span<const DepthView> views, const std::string& name,
                      std::chrono::nanoseconds time = stage_time) {
    const auto synthesiser = make_synthesiser("fused", shaders);
    synthesiser->set_views(views);
    return score(*synthesiser, stage, 0, name, views[0].colour.cols, views[0].colour.rows, time)
        .psnr_db;
}

/// A third of a pixel of disparity is ten pixels in the picture of a rig far aside.
TEST(MultiViewRefinementOnTheStage, WinsBackWhatSmoothErrorsOfDisparityCost) {
    constexpr int width_px = 240, height_px = 180;
    constexpr double disparity_error_px = 0.3;
    const EglContext context;
    const ShaderLibrary shaders;
    VirtualStage stage(shaders);
    std::vector<DepthView> views = film_arc(stage, width_px, height_px);
    const double exact_db = midway_psnr_db(stage, shaders, views, "refinement-exact");
    cv::RNG random(3);
    for (DepthView& view : views) {
        cv::Mat1f error_px(view.depth_m.size());
        random.fill(error_px, cv::RNG::NORMAL, 0, 1);
        cv::GaussianBlur(error_px, error_px, {}, 4);
        error_px *= disparity_error_px / cv::norm(error_px) * std::sqrt(error_px.total());
        const auto f_baseline = static_cast<float>(view.K(0, 0) * view.baseline_m);
        cv::Mat1f disparity_px = f_baseline / view.depth_m + error_px;
        view.depth_m = f_baseline / disparity_px;
    }
    const double refined_db = midway_psnr_db(stage, shaders, views, "refinement-refined");
    // Without a baseline depth counts as measured some other way, and stays as it is.
    for (DepthView& view : views) view.baseline_m = 0;
    const double as_they_are_db = midway_psnr_db(stage, shaders, views, "refinement-none");
    EXPECT_GE(refined_db, as_they_are_db + 3);
    EXPECT_GE(refined_db, exact_db - 6);
}

TEST(MultiViewRefinementOnTheStage, CarvesAwayWhatOtherRigsSeeThrough) {
    constexpr int width_px = 240, height_px = 180;
    const EglContext context;
    const ShaderLibrary shaders;
    VirtualStage stage(shaders);
    // Who stands behind the blocks, and how many rigs see it, changes as performers walk.
    constexpr std::array times{2s, 5s, 9s};
    double lost_db = 0;
    for (const auto time : times) {
        std::vector<DepthView> views = film_arc(stage, width_px, height_px, time);
        lost_db += midway_psnr_db(stage, shaders, views, "carving-clean", time) / times.size();
        // Blocks that hover in front of everything.
        for (std::size_t i = 0; i < views.size(); ++i) {
            views[i].depth_m = views[i].depth_m.clone();
            cv::rectangle(views[i].depth_m, cv::Rect(60 + 20 * static_cast<int>(i), 40, 30, 60),
                          cv::Scalar(2.0), cv::FILLED);
        }
        lost_db -= midway_psnr_db(stage, shaders, views, "carving-carved", time) / times.size();
    }
    EXPECT_LE(lost_db, 2.6);
}

/// Halos are errors beside depth edges.
/// Mean error beside the depth edges of a view between rigs, of 255.
std::map<std::string, double> errors_at_edges(std::initializer_list<const char*> names,
                                              double rig_deg) {
    const EglContext context;
    const ShaderLibrary shaders;
    VirtualStage stage(shaders);
    const DepthView views[] = {film(stage, -rig_deg), film(stage, rig_deg)};
    const DepthView truth = film(stage, 0);
    const VirtualView target{truth.colour.cols, truth.colour.rows, truth.K,
                             truth.world_from_camera};
    std::map<std::string, double> errors;
    for (const char* name : names) {
        const auto synthesiser = make_synthesiser(name, shaders);
        synthesiser->set_views(views);
        const ColourImage picture = synthesiser->render(target).download();
        errors[name] = mean_error(picture, truth.colour,
                                  depth_edge_band(truth.depth_m, 5) & covered_mask(picture));
    }
    return errors;
}

TEST(StageHalos, AreFewerInTheFusedPictureThanBetweenMeshes) {
    auto errors = errors_at_edges({"mesh", "fused"}, 15);
    EXPECT_LE(errors["fused"], 0.78 * errors["mesh"]);
}

/// What the paper's boundary layers are for.
TEST(StageHalos, AreFewerBetweenLayersThanBetweenMeshes) {
    auto errors = errors_at_edges({"mesh", "layered"}, 10);
    EXPECT_LE(errors["layered"], 0.95 * errors["mesh"])
        << errors["layered"] << " against " << errors["mesh"];
}

TEST(StageNoise, IsWeakerInTheFusedPictureThanInACameraOnAStillStage) {
    constexpr int width_px = 160, height_px = 120, instants = 12, settled_after = 6;
    constexpr double disparity_noise_px = 0.1;
    const EglContext context;
    const ShaderLibrary shaders;
    VirtualStage stage(shaders);
    const DepthView truth = film(stage, 0, width_px, height_px);
    const DepthView clean[] = {film(stage, -8, width_px, height_px),
                               film(stage, 8, width_px, height_px)};
    const auto synthesiser = make_synthesiser("fused", shaders);
    std::vector<ColourImage> fused, camera;
    cv::Mat1b covered(height_px, width_px, uchar{255});
    cv::RNG random(7);
    for (std::uint64_t instant = 0; instant < instants; ++instant) {
        std::vector<DepthView> views;
        for (const DepthView& view : clean) {
            DepthView& noisy = views.emplace_back(view);
            noisy.colour = view.colour.clone();
            add_sensor_noise(noisy.colour, {.sigma = 3, .seed = views.size()}, 0, instant);
            noisy.depth_m = view.depth_m.clone();
            const double f_baseline = view.K(0, 0) * view.baseline_m;
            for (float& z : noisy.depth_m)
                z = static_cast<float>(f_baseline /
                                       (f_baseline / z + random.gaussian(disparity_noise_px)));
        }
        synthesiser->set_views(views);
        const ColourImage picture =
            synthesiser->render({width_px, height_px, truth.K, truth.world_from_camera}).download();
        ColourImage real = truth.colour.clone();
        add_sensor_noise(real, {.sigma = 3, .seed = 99}, 0, instant);
        if (instant < settled_after) continue;
        fused.push_back(picture);
        camera.push_back(real);
        covered &= covered_mask(picture);
    }
    const double of_fused = deviation_along_time(fused, covered);
    const double of_camera = deviation_along_time(camera, covered);
    EXPECT_LE(of_fused, 0.4 * of_camera) << of_fused << " against " << of_camera;
}

TEST(StageFades, LetARigThatDropsOutGoInSteps) {
    const EglContext context;
    const ShaderLibrary shaders;
    VirtualStage stage(shaders);
    DepthView left = film(stage, -6, 160, 120), right = film(stage, 6, 160, 120);
    // Of another colour, so that its share shows.
    right.colour.setTo(cv::Scalar(255, 0, 0, 255));
    const VirtualView target{160, 120, left.K, camera_at(0, 160, 120).world_from_camera};
    const auto synthesiser = make_synthesiser("fused", shaders);
    const auto redness = [&](std::initializer_list<DepthView> views) {
        synthesiser->set_views(views);
        return cv::mean(synthesiser->render(target).download())[0];
    };
    const double both = redness({left, right});
    double before = both;
    const int fade_instants = static_cast<int>(std::lround(fade_s / nominal_dt_s));
    for (int instant = 1; instant < fade_instants; ++instant) {
        const double now = redness({left});
        EXPECT_LT(now, before + 0.5) << instant;
        before = now;
    }
    const double alone = redness({left});
    EXPECT_LT(alone, both - 10);
    const double back = redness({left, right});
    EXPECT_GT(back, alone);
    EXPECT_LT(back, both);
}

}  // namespace
}  // namespace vantage
