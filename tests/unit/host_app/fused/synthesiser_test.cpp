#include "host_app/synthesis/synthesiser.h"

#include <cmath>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "common/base/error.h"
#include "common/gl/context/egl_context.h"
#include "common/image/image_file.h"
#include "host_app/view_sets/image_metrics.h"
#include "host_app/view_sets/view_set.h"
#include "tests/support/data_folder.h"
#include "tests/support/thrown_sentence.h"
#include "tests/unit/host_app/fused/wall_and_square.h"

namespace vantage {
namespace {

VirtualView target_of(const DepthView& view) {
    return {view.colour.cols, view.colour.rows, view.K, view.world_from_camera};
}

class SynthesiserTest : public testing::TestWithParam<std::string> {
  protected:
    ColourImage render(std::span<const DepthView> views, const VirtualView& target) {
        synthesiser_->set_views(views);
        return synthesiser_->render(target).download();
    }

    EglContext context_;
    ShaderLibrary shaders_;
    std::unique_ptr<Synthesiser> synthesiser_ = make_synthesiser(GetParam(), shaders_);
};

TEST_P(SynthesiserTest, GivesBackTheOnlyViewFromWhereItWasTaken) {
    const DepthView view = wall_and_square(0, 61, 47);
    const ColourImage picture = render({&view, 1}, target_of(view));
    EXPECT_GT(psnr_db(picture, view.colour, covered_mask(picture)), 32);
    EXPECT_GT(coverage(picture), 0.8);
}

TEST_P(SynthesiserTest, CorrectsTheColoursOfAView) {
    DepthView view = wall_and_square(0, 61, 47);
    view.colour_correction.matrix << 0, 1, 0, 1, 0, 0, 0, 0, 0.5;
    view.colour_correction.tone = {1.1, 1, 0.9};
    const ColourImage picture = render({&view, 1}, target_of(view));
    EXPECT_GT(psnr_db(picture, view.colour_correction.apply(view.colour), covered_mask(picture)),
              32);
    EXPECT_GT(coverage(picture), 0.8);
}

TEST_P(SynthesiserTest, MeetsTheTruthBetweenTwoViews) {
    const DepthView views[] = {wall_and_square(-0.2, 121, 91), wall_and_square(0.2, 121, 91)};
    const DepthView truth = wall_and_square(0.03, 121, 91);
    const ColourImage picture = render(views, target_of(truth));
    EXPECT_GT(psnr_db(picture, truth.colour, covered_mask(picture)), 27);
    EXPECT_GT(coverage(picture), 0.85);
    // The middle is the square, and the square hides the wall.
    EXPECT_NEAR(picture(45, 60)[0], 220, 4);
}

TEST_P(SynthesiserTest, TakesViewsOfDifferentSizesAndSomeWithoutDepth) {
    DepthView small_map = wall_and_square(0.2, 120, 90);
    cv::resize(small_map.depth_m, small_map.depth_m, {60, 45}, 0, 0, cv::INTER_NEAREST);
    DepthView without_depth = wall_and_square(0, 77, 51);
    without_depth.depth_m.release();
    const DepthView views[] = {wall_and_square(-0.2, 91, 67), without_depth, small_map};
    const DepthView truth = wall_and_square(0, 121, 91);
    const ColourImage picture = render(views, target_of(truth));
    EXPECT_GT(psnr_db(picture, truth.colour, covered_mask(picture)), 24);
    EXPECT_GT(coverage(picture), 0.85);
}

TEST_P(SynthesiserTest, IsBlackAndUncoveredWithoutViews) {
    const VirtualView target = target_of(wall_and_square(0, 31, 21));
    EXPECT_EQ(coverage(render({}, target)), 0);
    DepthView nothing = wall_and_square(0, 31, 21);
    nothing.depth_m.setTo(0);
    const ColourImage picture = render({&nothing, 1}, target);
    EXPECT_EQ(coverage(picture), 0);
    EXPECT_EQ(cv::norm(picture, cv::NORM_INF), 0);
}

TEST_P(SynthesiserTest, ClaimsNothingFromBehindTheScene) {
    const DepthView views[] = {wall_and_square(-0.2, 61, 47), wall_and_square(0.2, 61, 47)};
    VirtualView behind = target_of(views[0]);
    behind.world_from_camera = look_at({0, 0, 8}, {0, 0, 0}, {0, -1, 0});
    EXPECT_LT(coverage(render(views, behind)), 0.02);
    VirtualView away = target_of(views[0]);
    away.world_from_camera = look_at({0, 0, 0}, {0, 0, -8}, {0, -1, 0});
    EXPECT_EQ(coverage(render(views, away)), 0);
}

TEST_P(SynthesiserTest, ShowsASceneFromTheSideWithoutStretchingTheSquare) {
    const DepthView view = wall_and_square(0, 121, 91);
    VirtualView side = target_of(view);
    side.world_from_camera = look_at({2, 0, 0.5}, {0, 0, 3}, {0, -1, 0});
    const ColourImage picture = render({&view, 1}, side);
    const double covered = coverage(picture);
    EXPECT_GT(covered, 0.15);
    EXPECT_LT(covered, 0.98);
}

TEST_P(SynthesiserTest, FollowsChangesOfSizeAndCount) {
    const DepthView large = wall_and_square(0, 121, 91), small = wall_and_square(0, 31, 23);
    const DepthView many[] = {wall_and_square(-0.4, 61, 47), wall_and_square(-0.2, 61, 47),
                              wall_and_square(0, 61, 47),    wall_and_square(0.2, 61, 47),
                              wall_and_square(0.4, 61, 47),  wall_and_square(0.6, 61, 47)};
    for (const DepthView* truth : {&large, &small, &large}) {
        const ColourImage picture = render(many, target_of(*truth));
        EXPECT_EQ(picture.size(), truth->colour.size());
        EXPECT_GT(psnr_db(picture, truth->colour, covered_mask(picture)), 20);
        const ColourImage alone = render({truth, 1}, target_of(*truth));
        EXPECT_GT(psnr_db(alone, truth->colour, covered_mask(alone)), 28);
    }
}

/// Those of the gallery too that make a picture of any views with depth.
INSTANTIATE_TEST_SUITE_P(All, SynthesiserTest, testing::ValuesIn([] {
                             std::vector<std::string> names{"facets", "layered", "mesh", "relief"};
                             for (const SynthesiserEntry& entry : synthesiser_entries())
                                 names.push_back(entry.name);
                             return names;
                         }()),
                         [](const auto& test) { return test.param; });

struct HeldOut {
    const char *synthesiser, *views, *name;
    double least_psnr_db;
};
void PrintTo(const HeldOut& held_out, std::ostream* out) {
    *out << held_out.synthesiser << " on " << held_out.views << " " << held_out.name;
}

class HeldOutViewTest : public testing::TestWithParam<HeldOut> {};

TEST_P(HeldOutViewTest, IsMetByTheOthers) {
    VANTAGE_REQUIRE_DATA(data);
    ViewSet set = load_view_set(data / "viewsets" / GetParam().views);
    const std::size_t index = set.index_of(GetParam().name);
    const DepthView truth = set.views[index];
    set.views.erase(set.views.begin() + static_cast<std::ptrdiff_t>(index));
    const EglContext context;
    const ShaderLibrary shaders;
    const auto synthesiser = make_synthesiser(GetParam().synthesiser, shaders);
    synthesiser->set_views(set.views);
    const ColourImage picture = synthesiser->render(target_of(truth)).download();
    EXPECT_GE(psnr_db(picture, truth.colour), GetParam().least_psnr_db);
}

INSTANTIATE_TEST_SUITE_P(RealViews, HeldOutViewTest,
                         testing::Values(HeldOut{"mesh", "aloe_half", "view3", 30.0},
                                         HeldOut{"mesh", "teddy", "im4", 28.0},
                                         HeldOut{"layered", "aloe_half", "view3", 31.0},
                                         HeldOut{"layered", "teddy", "im4", 29.0},
                                         HeldOut{"fused", "aloe_half", "view3", 36.0},
                                         HeldOut{"fused", "aloe_half", "view0", 32.4},
                                         HeldOut{"fused", "teddy", "im4", 30.9}));

/// A view that stands beside the only rig, which sees neither what is behind things nor what is
/// past the border.
struct BesideOneRig {
    const char *views, *rig, *name;
};
void PrintTo(const BesideOneRig& beside, std::ostream* out) {
    *out << beside.name << " from " << beside.views << " " << beside.rig;
}

class BesideOneRigTest : public testing::TestWithParam<BesideOneRig> {};

TEST_P(BesideOneRigTest, FusedIsNotBelowWarping) {
    VANTAGE_REQUIRE_DATA(data);
    const ViewSet set = load_view_set(data / "viewsets" / GetParam().views);
    const DepthView& rig = set.views[set.index_of(GetParam().rig)];
    const DepthView& truth = set.views[set.index_of(GetParam().name)];
    const EglContext context;
    const ShaderLibrary shaders;
    const auto psnr_of = [&](const char* name) {
        const auto synthesiser = make_synthesiser(name, shaders);
        synthesiser->set_views({&rig, 1});
        return psnr_db(synthesiser->render(target_of(truth)).download(), truth.colour);
    };
    const double fused_db = psnr_of("fused");
    for (const char* warping : {"mesh", "layered", "relief"})
        EXPECT_GE(fused_db, psnr_of(warping)) << warping;
}

INSTANTIATE_TEST_SUITE_P(RealViews, BesideOneRigTest,
                         testing::Values(BesideOneRig{"aloe_half", "view1", "view3"},
                                         BesideOneRig{"aloe_half", "view5", "view4"},
                                         BesideOneRig{"teddy", "im2", "im4"},
                                         BesideOneRig{"teddy", "im6", "im5"}));

TEST(FusedSynthesiser, IsNoWorseWithMoreRigsThanAPictureTakes) {
    const EglContext context;
    const ShaderLibrary shaders;
    std::vector<DepthView> views;
    for (const double x_m : {-0.2, 0.2, -0.4, 0.4}) views.push_back(wall_and_square(x_m, 121, 91));
    const DepthView truth = wall_and_square(0.03, 121, 91);
    ColourImage pictures[2];
    for (ColourImage& picture : pictures) {
        const auto synthesiser = make_synthesiser("fused", shaders);
        synthesiser->set_views(views);
        picture = synthesiser->render(target_of(truth)).download();
        views.push_back(wall_and_square(0.6, 121, 91));
    }
    EXPECT_GT(psnr_db(pictures[1], truth.colour), psnr_db(pictures[0], truth.colour) - 0.5);
    EXPECT_GT(coverage(pictures[1]), coverage(pictures[0]) - 0.005);
}

/// A grey wall at z = 4 m, seen along z.
DepthView grey_wall(const Eigen::Vector3d& from_m, double f_px, uchar grey) {
    DepthView view;
    view.name = std::to_string(grey);
    view.K = intrinsics(f_px, 121, 91);
    view.world_from_camera.translation() = from_m;
    view.depth_m = DepthImage(91, 121, static_cast<float>(4 - from_m.z()));
    view.colour = ColourImage(91, 121, cv::Vec4b(grey, grey, grey, 255));
    return view;
}

TEST(FusedSynthesiser, AsksOtherRigsOnlyWhereTheTwoMostUsefulOnesSeeNothing) {
    const EglContext context;
    const ShaderLibrary shaders;
    const auto synthesiser = make_synthesiser("fused", shaders);
    // The third sees more of the wall, but from aside.
    const DepthView views[] = {grey_wall({-0.1, 0, 0}, 180, 100), grey_wall({0.1, 0, 0}, 180, 100),
                               grey_wall({1, 0, 0}, 80, 200)};
    synthesiser->set_views(views);
    const ColourImage picture = synthesiser->render(target_of(grey_wall({}, 96, 0))).download();
    EXPECT_EQ(picture(45, 60)[0], 100);
    EXPECT_EQ(picture(45, 75)[0], 100);
    EXPECT_GT(picture(45, 115)[0], 190);
    EXPECT_EQ(picture(45, 115)[3], 255) << "is covered";
}

TEST(FusedSynthesiser, AsksAllRigsThatAreAboutAsClose) {
    const EglContext context;
    const ShaderLibrary shaders;
    const auto synthesiser = make_synthesiser("fused", shaders);
    const DepthView views[] = {grey_wall({-0.2, 0, 0}, 96, 100), grey_wall({0.2, 0, 0}, 96, 100),
                               grey_wall({0, 0.21, 0}, 96, 200)};
    synthesiser->set_views(views);
    const ColourImage picture = synthesiser->render(target_of(grey_wall({}, 96, 0))).download();
    EXPECT_NEAR(picture(45, 60)[0], 132, 8);
}

/// A plain square leaves a matcher nothing to hold on to; its colour tells it from the wall.
TEST(FusedSynthesiser, GuessesTheDepthOfWhatALikeColouredSurfaceSurrounds) {
    const EglContext context;
    const ShaderLibrary shaders;
    const DepthView truth = wall_and_square(-0.2, 121, 91);
    DepthView view = wall_and_square(0, 121, 91);
    // The square's right third, and a stripe of the wall beside it.
    view.depth_m(cv::Rect(68, 15, 30, 60)).setTo(0);
    const auto synthesiser = make_synthesiser("fused", shaders);
    synthesiser->set_views({&view, 1});
    const ColourImage picture = synthesiser->render(target_of(truth)).download();
    int misplaced = 0;
    for (int v = 24; v < 67; ++v)
        for (int u = 60; u < 110; ++u) {
            const bool is_red = picture(v, u)[0] > 120, should_be = truth.colour(v, u)[0] > 120;
            misplaced += is_red != should_be ? 1 : 0;
        }
    EXPECT_LT(misplaced, 60) << "of 43 rows";
    EXPECT_LT(picture(45, 88)[3], 128) << "a guess is not covered";
}

/// A black post of a pixel's width before the wall.
TEST(FusedSynthesiser, ShowsAPostOfOnePixel) {
    constexpr int post_px = 14;
    const EglContext context;
    const ShaderLibrary shaders;
    DepthView view = wall_and_square(0, 121, 91);
    view.colour.col(post_px).setTo(cv::Scalar(0, 0, 0, 255));
    view.depth_m.col(post_px).setTo(2.0f);
    const auto synthesiser = make_synthesiser("fused", shaders);
    synthesiser->set_views({&view, 1});
    const ColourImage picture = synthesiser->render(target_of(view)).download();
    const cv::Scalar post = cv::mean(picture.col(post_px)),
                     beside = cv::mean(picture.col(post_px - 4));
    EXPECT_LT(post[1], 0.5 * beside[1]);
}

/// Stripes as a camera sees them from `z_m` before a wall: lens and sensor take the more of their
/// contrast the farther it is.
DepthView striped_wall(double z_m) {
    constexpr double spread_px = 0.65, wave_m = 0.25, f_px = 96;
    DepthView view;
    view.name = std::to_string(z_m);
    view.K = intrinsics(f_px, 121, 91);
    view.world_from_camera.translation().z() = -z_m;
    view.depth_m = DepthImage(91, 121, static_cast<float>(z_m));
    view.colour.create(91, 121);
    const double per_px = 2 * CV_PI * z_m / (f_px * wave_m);
    const double contrast = std::exp(-0.5 * spread_px * spread_px * per_px * per_px);
    for (int v = 0; v < 91; ++v)
        for (int u = 0; u < 121; ++u) {
            const auto grey = cv::saturate_cast<uchar>(
                128 + 100 * contrast * std::sin(per_px * (u - view.K(0, 2)) + 0.4));
            view.colour(v, u) = cv::Vec4b(grey, grey, grey, 255);
        }
    return view;
}

TEST(FusedSynthesiser, IsAboutAsSharpAsACameraNearerThanTheRig) {
    const EglContext context;
    const ShaderLibrary shaders;
    const DepthView far = striped_wall(5.6), near = striped_wall(4);
    const auto synthesiser = make_synthesiser("fused", shaders);
    synthesiser->set_views({&far, 1});
    const ColourImage picture = synthesiser->render(target_of(near)).download();
    const cv::Rect middle(30, 20, 61, 51);
    cv::Scalar mean, seen, wanted, blurred;
    cv::meanStdDev(picture(middle), mean, seen);
    cv::meanStdDev(near.colour(middle), mean, wanted);
    cv::meanStdDev(far.colour(middle), mean, blurred);
    EXPECT_LT(blurred[0], 0.82 * wanted[0]);
    EXPECT_GT(seen[0], 0.87 * wanted[0]);
    EXPECT_LT(seen[0], 1.02 * wanted[0]);
}

TEST(FindSynthesiser, ListsTheGalleryApartWhenAskedForAnother) {
    EXPECT_NE(
        thrown_sentence([] { find_synthesiser("magic"); }).find("fused, points; in the gallery: "),
        std::string::npos);
    EXPECT_EQ(find_synthesiser("mesh").name, "mesh");
}

TEST(FindSynthesiser, RefusesOptionsThatThereAreNot) {
    EXPECT_NE(thrown_sentence([] { find_synthesiser("mesh:focal-m=3"); }).find("has no options"),
              std::string::npos);
}

}  // namespace
}  // namespace vantage
