#include <gtest/gtest.h>

#include "host_app/gallery/relief_warp.h"
#include "host_app/view_sets/image_metrics.h"
#include "tests/unit/host_app/fused/drawn_surfaces.h"
#include "tests/unit/host_app/gallery/gallery_rendering.h"
#include "tests/unit/host_app/gallery/gallery_scene.h"

namespace vantage {
namespace {

class ReliefTest : public GalleryRendering, public testing::WithParamInterface<const char*> {
  protected:
    ColourImage render(std::span<const DepthView> views, const VirtualView& target) {
        return GalleryRendering::render(std::string("relief:form=") + GetParam(), views, target);
    }
};

TEST_P(ReliefTest, ShowsTheParallaxOfOnePictureWithDepth) {
    const DepthView view = ball_and_wall(0, {161, 121}, true),
                    truth = ball_and_wall(12, {161, 121}, true);
    const ColourImage picture = render({&view, 1}, view_of_scene(truth));
    EXPECT_GT(coverage(picture), 0.75);
    EXPECT_GT(psnr_db(picture, truth.colour, covered_mask(picture)), 25);
    EXPECT_LT(psnr_db(view.colour, truth.colour, covered_mask(picture)), 20) << "else it is easy";
}

/// Nearer points have to be drawn last whichever way the camera has gone: aside, up, on or back.
TEST_P(ReliefTest, LetsTheNearerSurfaceHideTheFartherOne) {
    const DepthView view = ball_and_wall(0, {161, 121}, true);
    for (const Eigen::Vector3d& from :
         {Eigen::Vector3d(0.8, -0.2, -2.9), Eigen::Vector3d(-0.8, -0.2, -2.9),
          Eigen::Vector3d(0, 0.4, -2.8), Eigen::Vector3d(0, -0.9, -2.8),
          Eigen::Vector3d(0.2, -0.2, -2.2), Eigen::Vector3d(0.2, -0.2, -3.8)}) {
        const DepthView truth =
            BallScene{}.seen_from(look_at(from, {0, 0, 0}, {0, -1, 0}), view.K, view.colour.size());
        const Outline seen = red_outline(render({&view, 1}, view_of_scene(truth)));
        const Outline wanted = red_outline(truth.colour);
        EXPECT_NEAR(seen.middle.x, wanted.middle.x, 2) << from.transpose();
        EXPECT_NEAR(seen.middle.y, wanted.middle.y, 2) << from.transpose();
        EXPECT_GT(seen.area, 0.75 * wanted.area) << from.transpose();
        EXPECT_LT(seen.area, 1.05 * wanted.area) << from.transpose();
    }
}

TEST_P(ReliefTest, JoinsTheReliefsOfTwoRigs) {
    const DepthView views[] = {ball_and_wall(-12, {161, 121}, true),
                               ball_and_wall(12, {161, 121}, true)};
    const DepthView truth = ball_and_wall(1, {161, 121}, true);
    const ColourImage picture = render(views, view_of_scene(truth));
    EXPECT_GT(psnr_db(picture, truth.colour, covered_mask(picture)), 27);
    EXPECT_GT(coverage(picture), 0.9);
}

INSTANTIATE_TEST_SUITE_P(Forms, ReliefTest, testing::Values("prewarp", "search"),
                         [](const auto& test) { return std::string(test.param); });

TEST(ReliefWarp, LeavesAPictureAsItIsFromItsOwnPlace) {
    const EglContext context;
    const ShaderLibrary shaders;
    DrawnSurfaces surfaces(shaders);
    const DepthView view = ball_and_wall(0, {67, 45}, true);
    ReliefWarp relief(shaders);
    relief.warp(surfaces.add(view), view_of_scene(view));
    const cv::Mat colour = relief.colour().download(), depth_m = relief.depth_m().download();
    const cv::Size margin = relief.margin_px();
    const cv::Rect inside(margin.width, margin.height, 67, 45);
    int apart = 0;
    for (int v = 0; v < 45; ++v)
        for (int u = 0; u < 67; ++u)
            if (std::abs(depth_m.at<float>(v + margin.height, u + margin.width) -
                         view.depth_m(v, u)) > 0.01f * view.depth_m(v, u))
                ++apart;
    EXPECT_LT(apart, 0.02 * 67 * 45);
    EXPECT_LT(cv::norm(ColourImage(colour(inside)), view.colour, cv::NORM_L1) / (67 * 45 * 4), 1.5);
}

}  // namespace
}  // namespace vantage
