#include <cmath>

#include <gtest/gtest.h>

#include "common/gl/context/egl_context.h"
#include "common/gl/fullscreen_pass.h"
#include "tests/unit/host_app/fused/drawn_surfaces.h"

namespace vantage {
namespace {

const cv::Size depth_size_px(33, 25);
constexpr float softness = 0.005f;
const cv::Point depth_middle(16, 12);

/// Walls that fill their rigs' pictures, at the middle of a virtual camera's.
class FusedDepthTest : public testing::Test {
  protected:
    struct Wall {
        double x_m;
        float depth_m;
        float presence = 1;
        cv::Vec4b colour = {};
    };
    float fused(const std::vector<Wall>& walls) {
        DrawnSurfaces surfaces(shaders_);
        for (const Wall& wall : walls)
            surfaces.add(plain_wall(wall.x_m, depth_size_px, wall.depth_m, wall.colour));
        std::vector<DrawnLayer> drawn = surfaces.layers();
        for (std::size_t i = 0; i < walls.size(); ++i) drawn[i].presence = walls[i].presence;
        layers_.draw(drawn, camera_of(plain_wall(0, depth_size_px, 1, {})));
        const Texture depth_m(TextureFormat::r32f, depth_size_px.width, depth_size_px.height);
        FullscreenPass pass(shaders_, "fused_depth.frag",
                            {{"LAYERS", std::to_string(walls.size())}});
        Program& program = pass.use();
        layers_.bind(program);
        program.set("softness", softness);
        pass.draw(Framebuffer({&depth_m}));
        return DepthImage(depth_m.download())(depth_middle);
    }
    /// How much a rig at x counts for a point z ahead of the virtual camera.
    static double weight(double x_m, double z) { return 1 / (1 - z / std::hypot(x_m, z) + 1e-5); }

    EglContext context_;
    ShaderLibrary shaders_;
    RigLayers layers_{shaders_};
};

TEST_F(FusedDepthTest, AveragesConsistentRigsByTheAngleOfTheirLinesOfSight) {
    // Apart by less than the softness: both count in full.
    const double a = 2, b = 2.009;
    const double wa = weight(0.2, a), wb = weight(-0.4, b);
    const double wanted = (wa * a + wb * b) / (wa + wb);
    EXPECT_NEAR(fused({{0.2, 2}, {-0.4, 2.009f}}), wanted, 2e-4);
    EXPECT_GT(std::abs(wanted - 0.5 * (a + b)), 1e-3) << "an even mean would do as well";
    // A rig that fades counts less.
    EXPECT_NEAR(fused({{0.2, 2, 0.1f}, {-0.4, 2.009f}}), (0.1 * wa * a + wb * b) / (0.1 * wa + wb),
                2e-4);
}

TEST_F(FusedDepthTest, TakesTheNearestOfDifferentSurfaces) {
    EXPECT_NEAR(fused({{0.1, 4}, {-0.2, 2}}), 2, 2e-4);
    EXPECT_NEAR(fused({{0.1, 4}, {-0.2, 2}, {0.3, 2}}), 2, 2e-4);
}

TEST_F(FusedDepthTest, RejectsASurfaceThatMoreRigsSeeThroughThanHave) {
    EXPECT_NEAR(fused({{0.1, 4}, {-0.2, 2}, {0.3, 4}}), 4, 4e-4);
    EXPECT_NEAR(fused({{0.1, 4}, {-0.2, 2}, {0.3, 3}}), 3, 4e-4) << "one for it, one against it";
}

TEST_F(FusedDepthTest, RejectsASurfaceSeenThroughInAnotherColour) {
    const cv::Vec4b red(200, 40, 40, 255), blue(40, 40, 200, 255);
    EXPECT_NEAR(fused({{0.1, 4, 1, red}, {-0.2, 2, 1, blue}}), 4, 4e-4);
    EXPECT_NEAR(fused({{0.1, 4, 1, red}, {-0.2, 2, 1, red}}), 2, 2e-4) << "a matcher may err";
}

TEST_F(FusedDepthTest, KeepsASurfaceWithNothingBehindIt) {
    const cv::Vec4b red(200, 40, 40, 255), blue(40, 40, 200, 255);
    EXPECT_NEAR(fused({{0.1, -4, 1, red}, {-0.2, 2, 1, blue}}), 2, 2e-4);
}

TEST_F(FusedDepthTest, UsesInpaintedDepthOnlyWhereNoRigMeasured) {
    EXPECT_NEAR(fused({{0.1, -2}, {-0.2, 4}}), 4, 4e-4);
    EXPECT_NEAR(fused({{0.1, -2}, {-0.2, -4}}), -2, 2e-4) << "negative: guessed";
    // Inpainted depth that meets a measured surface counts.
    EXPECT_NEAR(fused({{0.1, -2.005f}, {-0.2, 2}}), 2.004, 1e-3);
}

/// Another rig's wrong surface would lie over the picture that the rig really took.
TEST_F(FusedDepthTest, KeepsARigsSurfaceAtItsOwnPlace) {
    EXPECT_NEAR(fused({{0.001, 4}, {-0.3, 2}}), 4, 4e-4);
    EXPECT_NEAR(fused({{-0.3, 2}, {0.001, 4}}), 4, 4e-4);
    EXPECT_NEAR(fused({{0.001, 4}, {-0.3, 2}, {0.3, 2}}), 4, 4e-4) << "against two rigs";
    EXPECT_NEAR(fused({{0.001, -4}, {-0.3, 2}}), 4, 4e-4) << "whatever depth it has there";
    EXPECT_NEAR(fused({{5, 4}, {-0.3, 2}}), 2, 2e-4) << "where it does not look";
    EXPECT_NEAR(fused({{0.001, 4, 0.0f}, {-0.3, 2}}), 2, 2e-4) << "while it is hidden";
}

/// The farther from its place, the less far another surface must be in front of the rig's.
TEST_F(FusedDepthTest, LetsOtherSurfacesInSmoothlyAwayFromARigsPlace) {
    EXPECT_NEAR(fused({{0.03, 4}, {-0.3, 2}}), 4, 4e-4);
    EXPECT_NEAR(fused({{0.05, 4}, {-0.3, 1.9f}}), 1.9, 2e-4);
    EXPECT_NEAR(fused({{0.05, 4}, {-0.3, 2.2f}}), 4, 4e-4);
    EXPECT_NEAR(fused({{0.075, 4}, {-0.3, 2}}), 2, 2e-4);
    EXPECT_NEAR(fused({{0.075, 4}, {-0.3, 3.8f}}), 4, 4e-4);
}

TEST_F(FusedDepthTest, IsNothingWhereNoRigLooks) { EXPECT_EQ(fused({{5, 2}, {-5, 3}}), 0); }

}  // namespace
}  // namespace vantage
