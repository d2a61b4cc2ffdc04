#include <gtest/gtest.h>

#include "common/gl/context/egl_context.h"
#include "host_app/synthesis/synthesiser.h"
#include "host_app/view_sets/image_metrics.h"
#include "tests/support/thrown_sentence.h"
#include "tests/unit/host_app/gallery/gallery_scene.h"

namespace vantage {
namespace {

/// Rigs around a ball that stands before a wall, at angles in degrees.
class HullTest : public testing::Test {
  protected:
    /// Lets the synthesiser see the empty wall, then the ball.
    void watch(std::initializer_list<double> angles_deg) {
        std::vector<DepthView> empty, full;
        for (const double angle_deg : angles_deg) {
            empty.push_back(ball_and_wall(angle_deg, {97, 73}, false));
            full.push_back(ball_and_wall(angle_deg, {97, 73}, true));
        }
        for (int i = 0; i < 8; ++i) synthesiser_->set_views(empty, 0.2);
        synthesiser_->set_views(full, 0.2);
    }

    EglContext context_;
    ShaderLibrary shaders_;
    std::unique_ptr<Synthesiser> synthesiser_ = make_synthesiser("hull", shaders_);
};

TEST_F(HullTest, ShowsABallWhereItIsFromBetweenTheRigs) {
    watch({-40, -13, 13, 40});
    const DepthView truth = ball_and_wall(0, {97, 73}, true);
    const ColourImage picture = synthesiser_->render(view_of_scene(truth)).download();
    const Outline seen = red_outline(picture), wanted = red_outline(truth.colour);
    EXPECT_NEAR(seen.middle.x, wanted.middle.x, 1.5);
    EXPECT_NEAR(seen.middle.y, wanted.middle.y, 1.5);
    // A hull holds the ball, and not much more.
    EXPECT_GT(seen.area, 0.97 * wanted.area);
    EXPECT_LT(seen.area, 1.25 * wanted.area);
    EXPECT_GT(psnr_db(picture, truth.colour), 24);
}

TEST_F(HullTest, IsLargerTheFewerRigsCutIt) {
    const VirtualView target = view_of_scene(ball_and_wall(0, {97, 73}, true));
    watch({-40, 40});
    const double two = red_outline(synthesiser_->render(target).download()).area;
    synthesiser_ = make_synthesiser("hull", shaders_);
    watch({-40, -13, 13, 40});
    EXPECT_GT(two, 1.05 * red_outline(synthesiser_->render(target).download()).area);
}

TEST_F(HullTest, SaysThatItKnowsNoSilhouettes) {
    const DepthView views[] = {ball_and_wall(-13, {61, 47}, true),
                               ball_and_wall(13, {61, 47}, true)};
    synthesiser_->set_views(views);
    EXPECT_NE(thrown_sentence([&] {
                  synthesiser_->render(view_of_scene(views[0]));
              }).find("silhouettes of two rigs or more"),
              std::string::npos);
}

}  // namespace
}  // namespace vantage
