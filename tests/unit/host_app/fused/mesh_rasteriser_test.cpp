#include <cmath>

#include <gtest/gtest.h>

#include "common/gl/context/egl_context.h"
#include "common/gl/fullscreen_pass.h"
#include "host_app/synthesis/rig_layers.h"
#include "tests/unit/common/gl/shader_folder.h"
#include "tests/unit/host_app/fused/drawn_surfaces.h"

namespace vantage {
namespace {

const cv::Size mesh_size_px(33, 25);
constexpr double near_m = 0.05;
const cv::Vec4b grey(128, 128, 128, 255);

class MeshRasteriserTest : public testing::Test {
  protected:
    MeshRasteriserTest() {
        folder_.write("copy_depth.frag",
                      "uniform sampler2D layer;\nlayout(location = 0) out float depth;\n"
                      "void main() { depth = texelFetch(layer, ivec2(gl_FragCoord.xy), 0).r; }");
    }
    /// Metres; 0 where there is nothing.
    DepthImage drawn(const RigSurface& surface, const VirtualView& target,
                     QuadGrid grid = QuadGrid::fine) {
        DrawnDepth layer;
        layer.resize({target.width_px, target.height_px});
        rasteriser_.draw_depth(surface, target, near_m, layer.target(), grid);
        const Texture copy(TextureFormat::r32f, target.width_px, target.height_px);
        FullscreenPass pass(shaders_, "copy_depth.frag");
        pass.use().set("layer", 0);
        layer.texture().bind(0);
        pass.draw(Framebuffer({&copy}));
        DepthImage depth_m = copy.download();
        for (float& z : depth_m) z = z < 1 ? static_cast<float>(near_m / (1 - double{z})) : 0.0f;
        return depth_m;
    }

    EglContext context_;
    ShaderFolder folder_;
    ShaderLibrary shaders_{folder_.path()};
    DrawnSurfaces surfaces_{shaders_};
    MeshRasteriser rasteriser_{shaders_};
};

/// The plane x * slope + z = distance, as a camera at x sees it.
DepthView slanted_plane(double slope, double distance_m) {
    DepthView view = plain_wall(0, mesh_size_px, 1, grey);
    for (int y = 0; y < mesh_size_px.height; ++y)
        for (int x = 0; x < mesh_size_px.width; ++x)
            view.depth_m(y, x) =
                static_cast<float>(distance_m / (1 + slope * (x - view.K(0, 2)) / view.K(0, 0)));
    return view;
}

/// Where the virtual camera's ray meets the plane, if the rig has that place in its picture.
TEST_F(MeshRasteriserTest, DrawsAPlaneWhereTheRaysMeetIt) {
    for (const double slope : {0.0, 0.3}) {
        const double distance_m = 2;
        const DepthView view = slanted_plane(slope, distance_m);
        const RigSurface& surface = surfaces_.add(view);
        VirtualView target = camera_of(view);
        target.width_px = 41;
        target.K(0, 0) *= 1.1;
        target.world_from_camera.translation() = Eigen::Vector3d(0.21, -0.1, -0.3);
        target.world_from_camera.linear() =
            Eigen::AngleAxisd(-0.1, Eigen::Vector3d::UnitY()).matrix();
        for (const QuadGrid grid : {QuadGrid::fine, QuadGrid::coarse}) {
            const DepthImage depth_m = drawn(surface, target, grid);
            int inside = 0, outside = 0;
            for (int y = 0; y < target.height_px; ++y)
                for (int x = 0; x < target.width_px; ++x) {
                    const Eigen::Vector3d ray = target.K.inverse() * Eigen::Vector3d(x, y, 1);
                    const Eigen::Vector3d along = target.world_from_camera.linear() * ray;
                    const Eigen::Vector3d from = target.world_from_camera.translation();
                    const double z = (distance_m - slope * from.x() - from.z()) /
                                     (slope * along.x() + along.z());
                    const Eigen::Vector3d pixel = view.K * (from + z * along);
                    const double u = pixel.x() / pixel.z(), v = pixel.y() / pixel.z();
                    const double in =
                        std::min({u, v, mesh_size_px.width - 1 - u, mesh_size_px.height - 1 - v});
                    if (in > 0.05) {
                        // 24 bits of depth and floats.
                        EXPECT_NEAR(depth_m(y, x), z, 2e-4 * z) << x << ' ' << y;
                        ++inside;
                    } else if (in < -0.05) {
                        EXPECT_EQ(depth_m(y, x), 0) << x << ' ' << y;
                        ++outside;
                    }
                }
            EXPECT_GT(inside, 300);
            EXPECT_GT(outside, 100);
        }
    }
}

TEST_F(MeshRasteriserTest, ShowsTheNearerOfTwoSurfacesAndNothingBetweenThem) {
    DepthView view = plain_wall(0, mesh_size_px, 4, grey);
    view.depth_m(cv::Rect(8, 6, 10, 10)) = 2.0f;
    const RigSurface& surface = surfaces_.add(view);
    VirtualView target = camera_of(view);
    // 8 px of parallax at 2 m, 4 at 4 m: the square moves over the wall to its left.
    target.world_from_camera.translation().x() = 16.0 / mesh_size_px.width;
    const DepthImage depth_m = drawn(surface, target);
    EXPECT_NEAR(depth_m(10, 5), 2, 1e-3);
    EXPECT_NEAR(depth_m(10, 20), 4, 1e-3);
    // Between the square's right edge, at 17 - 8 px, and the wall's, at 18 - 4, no rig has seen.
    for (int x = 10; x < 14; ++x) EXPECT_EQ(depth_m(10, x), 0) << x;
    for (const float z : depth_m)
        EXPECT_TRUE(z == 0 || std::abs(z - 2) < 1e-3 || std::abs(z - 4) < 1e-3);
}

TEST_F(MeshRasteriserTest, LeavesOutWhatIsSeenFromBehind) {
    const DepthView view = plain_wall(0, mesh_size_px, 2, grey);
    const RigSurface& surface = surfaces_.add(view);
    VirtualView behind = camera_of(view);
    behind.world_from_camera.translation().z() = 4;
    behind.world_from_camera.linear() = Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitY()).matrix();
    EXPECT_EQ(cv::countNonZero(drawn(surface, behind)), 0);
}

/// A quad grid shows nothing of a post of one pixel; its rims are half a pixel on each side, four
/// columns of a camera with four times the focal length.
TEST_F(MeshRasteriserTest, DrawsRimsHalfAPixelWide) {
    DepthView view = plain_wall(0, mesh_size_px, 4, grey);
    view.depth_m.col(16) = 2.0f;
    VirtualView close = camera_of(view);
    close.width_px *= 4;
    close.height_px *= 4;
    close.K.topRows<2>() *= 4;
    close.K(0, 2) += 1.5;
    close.K(1, 2) += 1.5;
    const auto post_columns = [&](bool has_rims) {
        const DepthImage depth_m = drawn(surfaces_.add(view, has_rims), close);
        return cv::countNonZero(cv::abs(depth_m.row(50) - 2) < 0.1);
    };
    EXPECT_EQ(post_columns(false), 0);
    EXPECT_EQ(post_columns(true), 4);
}

/// From aside a body's outline is another one: the rims of 0.28 rad are a quarter as wide.
TEST_F(MeshRasteriserTest, DrawsNarrowerRimsFromAside) {
    DepthView view = plain_wall(0, mesh_size_px, 4, grey);
    view.depth_m.col(16) = 2.0f;
    VirtualView aside = camera_of(view);
    aside.width_px *= 8;
    aside.height_px *= 8;
    aside.K.topRows<2>() *= 8;
    const double angle_rad = 0.28;
    // About the middle of what the rig sees, its median depth ahead.
    aside.world_from_camera.translation() =
        Eigen::Vector3d(-4 * std::sin(angle_rad), 0, 4 - 4 * std::cos(angle_rad));
    aside.world_from_camera.linear() =
        Eigen::AngleAxisd(angle_rad, Eigen::Vector3d::UnitY()).matrix();
    const DepthImage depth_m = drawn(surfaces_.add(view, true), aside);
    const int columns = cv::countNonZero(cv::abs(depth_m.row(8 * 12) - 2) < 0.3);
    // A quarter of the pixel's 8 columns, seen from aside and nearer or farther than the rig.
    EXPECT_NEAR(columns, 2, 1);
}

}  // namespace
}  // namespace vantage
