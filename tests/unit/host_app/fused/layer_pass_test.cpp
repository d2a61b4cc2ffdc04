#include <cmath>

#include <gtest/gtest.h>

#include "common/gl/context/egl_context.h"
#include "host_app/surfaces/drawn_texture.h"
#include "host_app/synthesis/rig_layers.h"
#include "tests/unit/host_app/fused/drawn_surfaces.h"

namespace vantage {
namespace {

const cv::Size layer_size_px(49, 37);
const cv::Vec4b layer_red(200, 20, 20, 255), layer_blue(20, 20, 200, 255);
const cv::Point layer_middle(24, 18);

double closeness(double x_m, double z) { return 1 / (1 - z / std::hypot(x_m, z) + 1e-5); }

/// The passes of the synthesisers `mesh` and `layered`, which merge what RigLayers drew.
class LayerPassTest : public testing::Test {
  protected:
    DepthView& add(double x_m, float depth_m, const cv::Vec4b& colour) {
        return views_.emplace_back(plain_wall(x_m, layer_size_px, depth_m, colour));
    }
    struct Drawn {
        cv::Vec4b colour, shares;
        float depth_m;
    };
    Drawn draw(const char* fragment, std::size_t layers_a_rig) {
        DrawnSurfaces surfaces(shaders_);
        for (const DepthView& view : views_) surfaces.add(view);
        layers_.draw(surfaces.layers(), camera_of(plain_wall(0, layer_size_px, 1, {})));
        LayerPass pass(shaders_, fragment, 0.005f, {}, layers_a_rig);
        DepthPicture picture;
        picture.resize(layer_size_px, true);
        pass.use(layers_, true).draw(picture.target());
        return {ColourImage(picture.colour().download())(layer_middle),
                ColourImage(picture.shares()->download())(layer_middle),
                DepthImage(picture.depth_m().download())(layer_middle)};
    }
    static void expect_near(const cv::Vec4b& seen, const cv::Vec4b& a, double share,
                            const cv::Vec4b& b) {
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(seen[c], share * a[c] + (1 - share) * b[c], 1);
    }

    EglContext context_;
    ShaderLibrary shaders_;
    RigLayers layers_{shaders_};
    std::vector<DepthView> views_;
};

TEST_F(LayerPassTest, BlendsMeshesThatMeetByTheAngleOfTheirLinesOfSight) {
    add(-0.2, 2, layer_red);
    add(0.3, 2, layer_blue);
    const double share = closeness(-0.2, 2) / (closeness(-0.2, 2) + closeness(0.3, 2));
    const Drawn drawn = draw("mesh_blend.frag", 1);
    expect_near(drawn.colour, layer_red, share, layer_blue);
    EXPECT_EQ(drawn.colour[3], 255);
    EXPECT_NEAR(drawn.shares[0], 255 * share, 1);
    EXPECT_NEAR(drawn.depth_m, 2, 1e-3);
}

TEST_F(LayerPassTest, ShowsTheNearerOfMeshesThatDoNotMeet) {
    add(-0.2, 2, layer_red);
    add(0.3, 3, layer_blue);
    expect_near(draw("mesh_blend.frag", 1).colour, layer_red, 1, layer_blue);
    views_[0].depth_m.setTo(4.0f);
    expect_near(draw("mesh_blend.frag", 1).colour, layer_blue, 1, layer_red);
}

TEST_F(LayerPassTest, LaysAMattedBoundaryLayerOverTheMainLayer) {
    add(-0.2, 4, layer_blue);
    add(-0.2, 2, {200, 20, 20, 102});
    const Drawn drawn = draw("layered_blend.frag", 2);
    expect_near(drawn.colour, layer_red, 0.4, layer_blue);
    EXPECT_NEAR(drawn.shares[0], 255 * 0.6, 1);
    EXPECT_NEAR(drawn.shares[1], 255 * 0.4, 1);
    EXPECT_NEAR(drawn.depth_m, 4, 2e-3) << "what has the larger share";
}

TEST_F(LayerPassTest, HidesABoundaryLayerBehindTheMainLayer) {
    add(-0.2, 2, layer_blue);
    add(-0.2, 3, layer_red);
    expect_near(draw("layered_blend.frag", 2).colour, layer_blue, 1, layer_red);
}

}  // namespace
}  // namespace vantage
