#include "host_app/fused/foreground_layers.h"

#include <gtest/gtest.h>

#include "common/gl/context/egl_context.h"
#include "tests/unit/host_app/fused/drawn_surfaces.h"

namespace vantage {
namespace {

const cv::Size rig_size_px(64, 48);
const cv::Vec4b near_red(255, 0, 0, 255), far_green(0, 255, 0, 255), set_blue(0, 0, 255, 255);

class ForegroundLayersTest : public testing::Test {
  protected:
    ForegroundLayersTest() {
        background_colour_.upload(ColourImage(rig_size_px, set_blue));
        background_depth_.upload(DepthImage(rig_size_px, 8.0f));
    }
    /// Columns from `from` to `to` of one colour and depth.
    static void stand(DepthView& view, int from, int to, float depth_m, const cv::Vec4b& colour) {
        const cv::Rect place(from, 8, to - from, 32);
        view.colour(place).setTo(colour);
        view.depth_m(place).setTo(depth_m);
    }
    /// A row of what the virtual camera at x sees.
    ColourImage row(double x_m) {
        DepthView view = plain_wall(x_m, rig_size_px, 8, set_blue);
        const DepthPicture& shown = layers_.show(background_colour_, background_depth_, nullptr,
                                                 surfaces_.layers(), camera_of(view), false);
        return ColourImage(ColourImage(shown.colour().download()).row(24));
    }

    EglContext context_;
    ShaderLibrary shaders_;
    Texture background_colour_{TextureFormat::rgba8, rig_size_px.width, rig_size_px.height};
    Texture background_depth_{TextureFormat::r32f, rig_size_px.width, rig_size_px.height};
    DrawnSurfaces surfaces_{shaders_};
    ForegroundLayers layers_{shaders_};
};

/// Two performers side by side, of whom the nearer one's depth goes on beyond its matte.
TEST_F(ForegroundLayersTest, NothingBeyondAMatteHidesAPerformer) {
    DepthView view = plain_wall(0, rig_size_px, 0, cv::Vec4b(0, 0, 0, 0));
    stand(view, 10, 26, 2, near_red);
    stand(view, 26, 32, -2, cv::Vec4b(0, 0, 0, 0));
    stand(view, 32, 60, 4, far_green);
    surfaces_.add(view);
    EXPECT_EQ(row(0)(0, 18), near_red);
    EXPECT_EQ(row(0)(0, 28), set_blue);
    EXPECT_EQ(row(0)(0, 40), far_green);
    // Eight pixels to the right what is near, four what is far: red to 34, green from 36 on.
    const ColourImage aside = row(-0.25);
    EXPECT_EQ(aside(0, 26), near_red);
    for (int x = 38; x < 60; ++x) EXPECT_EQ(aside(0, x), far_green) << x;
}

/// A wrong depth of the background, in front of a performer.
TEST_F(ForegroundLayersTest, ABackgroundThatARigSeesPastHidesNobody) {
    DepthView view = plain_wall(0, rig_size_px, 0, cv::Vec4b(0, 0, 0, 0));
    stand(view, 10, 26, 2, near_red);
    surfaces_.add(view);
    background_depth_.upload(DepthImage(rig_size_px, 1.0f));
    EXPECT_EQ(row(0)(0, 18), near_red);
    // Eight pixels to the right what is near, and sixteen what is before it: the rig sees no
    // foreground at its eighth column, where it would see what hides the performer at the 24th.
    const ColourImage aside = row(-0.25);
    EXPECT_EQ(aside(0, 30), near_red);
    EXPECT_EQ(aside(0, 22), set_blue);
}

}  // namespace
}  // namespace vantage
