#include "host_app/synthesis/rig_layers.h"

#include <cmath>

#include <gtest/gtest.h>

#include "common/gl/context/egl_context.h"
#include "common/gl/fullscreen_pass.h"
#include "tests/unit/common/gl/shader_folder.h"
#include "tests/unit/host_app/fused/drawn_surfaces.h"

namespace vantage {
namespace {

const cv::Size size_px(33, 25);

/// What a shader that includes rig_layers.glsl is given of two rigs.
class RigLayersTest : public testing::Test {
  protected:
    struct Seen {
        cv::Mat_<cv::Vec4f>
            place;  ///< depth, angle-like measure, share of the rig, level of detail
        cv::Mat_<cv::Vec4f> source;  ///< colour there, its depth map there
    };

    RigLayersTest() {
        folder_.write("probe.frag", R"(
#define LAYERS 2
#include "rig_layers.glsl"
layout(location = 0) out vec4 place[2];
layout(location = 2) out vec4 source[2];
#define PROBE(i) { \
    float z = layer_z(layer_depth[i], at); \
    vec4 q = pixel_from_target[i] * vec4(vec2(at) * z, z, 1.0); \
    vec2 uv = (q.xy / q.z + 0.5) / colour_size[i]; \
    place[i] = vec4(z, apart(ray_from_pixel * vec3(vec2(at), 1.0) * z, centre[i]), presence[i], \
                    detail_level(pixel_from_target[i], z, q.z)); \
    source[i] = vec4(textureLod(colour[i], uv, 0.0).rgb, textureLod(source_depth[i], uv, 0.0).r); }
void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    FOR_LAYERS(PROBE)
}
)");
    }
    std::array<Seen, 2> seen_by(const VirtualView& target) {
        const cv::Size size(target.width_px, target.height_px);
        const Texture textures[4] = {{TextureFormat::rgba32f, size.width, size.height},
                                     {TextureFormat::rgba32f, size.width, size.height},
                                     {TextureFormat::rgba32f, size.width, size.height},
                                     {TextureFormat::rgba32f, size.width, size.height}};
        FullscreenPass pass(shaders_, "probe.frag");
        layers_.bind(pass.use());
        pass.draw(Framebuffer({&textures[0], &textures[1], &textures[2], &textures[3]}));
        std::array<Seen, 2> seen;
        for (std::size_t i = 0; i < 2; ++i)
            seen[i] = {textures[i].download(), textures[2 + i].download()};
        return seen;
    }
    /// A wall whose red and green tell the pixel.
    static DepthView told_wall(double x_m, float depth_m) {
        DepthView view = plain_wall(x_m, size_px, depth_m, {0, 0, 0, 255});
        for (int y = 0; y < size_px.height; ++y)
            for (int x = 0; x < size_px.width; ++x)
                view.colour(y, x) =
                    cv::Vec4b(static_cast<uchar>(5 * x), static_cast<uchar>(5 * y), 77, 255);
        return view;
    }

    EglContext context_;
    ShaderFolder folder_;
    ShaderLibrary shaders_{folder_.path()};
    DrawnSurfaces surfaces_{shaders_};
    RigLayers layers_{shaders_};
};

TEST_F(RigLayersTest, GiveAShaderEachRigsSurfaceAndPicture) {
    const std::array<double, 2> x_m{-0.4, 0.3};
    const std::array<float, 2> depth_m{2, 3};
    for (std::size_t i = 0; i < 2; ++i) surfaces_.add(told_wall(x_m[i], depth_m[i]));
    std::vector<DrawnLayer> drawn = surfaces_.layers();
    drawn[1].presence = 0.25f;
    VirtualView target = camera_of(told_wall(0, 1));
    layers_.draw(drawn, target);
    const std::array<Seen, 2> seen = seen_by(target);
    const double f = size_px.width;
    for (std::size_t i = 0; i < 2; ++i)
        for (int y = 1; y < size_px.height - 1; ++y)
            for (int x = 0; x < size_px.width; ++x) {
                const double z = depth_m[i], u = x - f * x_m[i] / z;
                const cv::Vec4f place = seen[i].place(y, x), source = seen[i].source(y, x);
                if (u < -0.05 || u > size_px.width - 0.95) {
                    EXPECT_GT(place[0], 1e29) << x << ' ' << y;
                    continue;
                }
                if (u < 0.05 || u > size_px.width - 1.05) continue;
                EXPECT_NEAR(place[0], z, 2e-4 * z) << x << ' ' << y;
                const Eigen::Vector3d point = z * target.K.inverse() * Eigen::Vector3d(x, y, 1);
                const Eigen::Vector3d from_rig = point - Eigen::Vector3d(x_m[i], 0, 0);
                EXPECT_NEAR(place[1], 1 - point.normalized().dot(from_rig.normalized()), 1e-5);
                EXPECT_EQ(place[2], i == 0 ? 1.0f : 0.25f);
                EXPECT_NEAR(place[3], 0, 1e-4);
                // Bilinear, in 8 bits: a fifth of a pixel.
                EXPECT_NEAR(255 * source[0], 5 * u, 1) << x << ' ' << y;
                EXPECT_NEAR(255 * source[1], 5 * y, 1);
                EXPECT_NEAR(source[3], z, 1e-5);
            }
}

TEST_F(RigLayersTest, TellHowMuchFinerARigsPictureIs) {
    for (const double x_m : {0.0, 0.1}) surfaces_.add(told_wall(x_m, 2));
    // A pixel of a quarter of the focal length is four of the rig's.
    VirtualView wide = camera_of(told_wall(0, 2));
    wide.K(0, 0) /= 4;
    wide.K(1, 1) /= 4;
    layers_.draw(surfaces_.layers(), wide);
    EXPECT_NEAR(seen_by(wide)[0].place(12, 16)[3], 2, 1e-4);
}

/// A strip two pixels wide is a quad of the fine grid and none of the coarse one.
TEST_F(RigLayersTest, DrawTheFirstSurfacesByEveryPixel) {
    DepthView strip = told_wall(0, 4);
    strip.depth_m.col(15) = 2.0f;  // Between the corners of coarse quads.
    for (int i = 0; i < 2; ++i) surfaces_.add(strip, true);
    const VirtualView target = camera_of(strip);
    const std::vector<DrawnLayer> drawn = surfaces_.layers();
    const auto has_strip = [&](std::size_t i) {
        const float z = seen_by(target)[i].place(12, 15)[0];
        return z > 1.9f && z < 2.1f;
    };
    layers_.draw(drawn, target, 1);
    EXPECT_TRUE(has_strip(0));
    EXPECT_FALSE(has_strip(1));
    layers_.draw(drawn, target);
    EXPECT_TRUE(has_strip(1));
}

TEST_F(RigLayersTest, HaveANearPlaneAtAHundredthOfTheFarthestMedianDepth) {
    EXPECT_EQ(near_plane_m({}), 0.01);
    for (const float depth_m : {2.0f, 5.0f, 3.0f}) surfaces_.add(told_wall(0, depth_m));
    EXPECT_NEAR(near_plane_m(surfaces_.layers()), 0.05, 1e-9);
}

}  // namespace
}  // namespace vantage
