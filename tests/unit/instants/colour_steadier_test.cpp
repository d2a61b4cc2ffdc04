#include "host_app/instants/colour_steadier.h"

#include <gtest/gtest.h>

#include "common/gl/egl_context.h"
#include "common/virtual_stage/virtual_rig.h"
#include "tests/support/deviation_along_time.h"
#include "tests/unit/synthesis/wall_and_square.h"

namespace vantage {
namespace {

class ColourSteadierTest : public testing::Test {
  protected:
    static constexpr int width_px = 81, height_px = 59;

    /// A rig's picture with noise of two grey levels; the square stands at square_x_m.
    ColourImage filmed(double square_x_m = 0, double sigma = 2) {
        ColourImage picture =
            wall_and_square(0, width_px, height_px, {.square_x_m = square_x_m}).colour;
        add_sensor_noise(picture, {.sigma = sigma}, 0, instant_++);
        return picture;
    }
    ColourImage next(const ColourImage& picture) {
        DepthView view = wall_and_square(0, width_px, height_px);
        view.colour = picture;
        view_.upload(view);
        steadier_.steady(view_);
        return view_.colour().download();
    }

    EglContext context_;
    ShaderLibrary shaders_;
    ColourSteadier steadier_{shaders_};
    RigHistory view_;
    std::uint64_t instant_ = 0;
};

TEST_F(ColourSteadierTest, TakesTheNoiseOutOfWhatStandsStill) {
    std::vector<ColourImage> noisy, steady;
    for (int i = 0; i < 24; ++i) {
        const ColourImage picture = filmed();
        const ColourImage mean = next(picture);
        if (i < 12) continue;
        noisy.push_back(picture);
        steady.push_back(mean);
    }
    const cv::Mat1b everywhere(height_px, width_px, uchar{255});
    EXPECT_LT(deviation_along_time(steady, everywhere),
              0.5 * deviation_along_time(noisy, everywhere));
}

TEST_F(ColourSteadierTest, LeavesNoTrailOfWhatMoves) {
    for (int i = 0; i < 12; ++i) (void)next(filmed(0, 0));
    const ColourImage moved = filmed(0.4, 0);
    EXPECT_LT(cv::norm(next(moved), moved, cv::NORM_INF), 6);
    EXPECT_LT(cv::norm(next(moved), moved, cv::NORM_INF), 6);
}

/// Each step is smaller than what counts as noise.
TEST_F(ColourSteadierTest, FollowsALampThatIsDimmedSlowly) {
    ColourImage dimmed;
    cv::Mat shown;
    for (int i = 0; i < 60; ++i) {
        dimmed = ColourImage(filmed(0, 0) - cv::Scalar(i, i, i, 0));
        shown = next(dimmed);
    }
    cv::Mat behind;
    cv::absdiff(shown, dimmed, behind);
    EXPECT_LT(cv::norm(behind, cv::NORM_INF), 8);
}

TEST_F(ColourSteadierTest, KnowsNoPastOfARigThatWasNotDrawn) {
    for (int i = 0; i < 12; ++i) (void)next(filmed());
    DepthView view = wall_and_square(0, width_px, height_px);
    view_.upload(view);  // and nothing is made of it
    const ColourImage picture = filmed();
    EXPECT_EQ(cv::norm(next(picture), picture, cv::NORM_INF), 0);
}

}  // namespace
}  // namespace vantage
