#include <array>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "common/gl/context/egl_context.h"
#include "host_app/surfaces/rig_surface.h"

namespace vantage {
namespace {

using Triangle = std::array<std::uint32_t, 3>;
constexpr int grid_width_px = 9, grid_height_px = 7;

int column(std::uint32_t pixel) { return static_cast<int>(pixel) % grid_width_px; }
int row(std::uint32_t pixel) { return static_cast<int>(pixel) / grid_width_px; }

class TriangleBuilderTest : public testing::Test {
  protected:
    void look_at(const DepthImage& depth_m) {
        DepthView view;
        view.depth_m = depth_m;
        view.colour = ColourImage(depth_m.size());
        // A single step of inverse depth by 8 / 900 is an edge, and any step by three times that.
        view.K << 900, 0, 4, 0, 900, 3, 0, 0, 1;
        std::unique_ptr<ColourCorrector> corrector;
        std::unique_ptr<DepthUploader> uploader;
        surface_.upload(view, corrector, uploader);
    }
    std::vector<Triangle> built(QuadGrid grid) {
        builder_.build(surface_.grid(grid));
        return read(surface_.triangles(grid));
    }
    std::vector<Triangle> built_rims() {
        builder_.build_rims(surface_);
        return read(*surface_.rims());
    }
    static std::vector<Triangle> read(const IndirectTriangles& triangles) {
        std::array<std::uint32_t, 5> command{};
        triangles.command.read(0, std::as_writable_bytes(std::span(command)));
        std::vector<std::uint32_t> indices(command[0]);
        triangles.indices.read(0, std::as_writable_bytes(std::span(indices)));
        std::vector<Triangle> all;
        for (std::size_t i = 0; i + 2 < indices.size(); i += 3)
            all.push_back({indices[i], indices[i + 1], indices[i + 2]});
        return all;
    }
    static int doubled_area(const Triangle& t) {
        return (column(t[1]) - column(t[0])) * (row(t[2]) - row(t[0])) -
               (column(t[2]) - column(t[0])) * (row(t[1]) - row(t[0]));
    }
    /// Twice the covered area; all triangles must have the same orientation.
    static int covered(const std::vector<Triangle>& all) {
        int sum = 0;
        for (const Triangle& t : all) {
            EXPECT_GT(doubled_area(t), 0);
            sum += doubled_area(t);
        }
        return sum;
    }
    /// Whether a triangle reaches from one depth to another.
    static bool mixes(const DepthImage& depth_m, const Triangle& t) {
        const float z = depth_m(row(t[0]), column(t[0]));
        return depth_m(row(t[1]), column(t[1])) != z || depth_m(row(t[2]), column(t[2])) != z;
    }

    EglContext context_;
    ShaderLibrary shaders_;
    TriangleBuilder builder_{shaders_};
    RigSurface surface_;
};

TEST_F(TriangleBuilderTest, SpansASlantedPlaneWhoseStepsWouldBeEdgesAlone) {
    DepthImage slanted(grid_height_px, grid_width_px);
    for (int y = 0; y < grid_height_px; ++y)
        for (int x = 0; x < grid_width_px; ++x)
            slanted(y, x) =
                1 / (1 + 0.011f * static_cast<float>(x) + 0.003f * static_cast<float>(y));
    for (const DepthImage& depth_m : {DepthImage(grid_height_px, grid_width_px, 3.0f), slanted})
        for (const QuadGrid grid : {QuadGrid::fine, QuadGrid::coarse}) {
            look_at(depth_m);
            const int spanned = covered(built(grid));
            EXPECT_GE(spanned, 2 * 8 * 6) << static_cast<int>(grid);
            // Flat quarters of a block take a pixel of their neighbours each.
            EXPECT_LE(spanned, grid == QuadGrid::fine ? 2 * 8 * 6 : 4 * 8 * 6);
        }
}

TEST_F(TriangleBuilderTest, LeavesOutStepsThatAreSteeperThanAnySurface) {
    DepthImage steep(grid_height_px, grid_width_px);
    for (int y = 0; y < grid_height_px; ++y)
        for (int x = 0; x < grid_width_px; ++x)
            steep(y, x) = 1 / (1 + 0.04f * static_cast<float>(x));
    look_at(steep);
    EXPECT_EQ(covered(built(QuadGrid::fine)), 0);
}

TEST_F(TriangleBuilderTest, CutsBetweenSurfacesAndAroundUnknownPixels) {
    // The near corner takes 4 x 3 pixels: 5 quads are cut, and of a sixth one corner.
    DepthImage corner(grid_height_px, grid_width_px, 4.0f);
    corner(cv::Rect(0, 0, 4, 3)) = 2.0f;
    look_at(corner);
    const std::vector<Triangle> around = built(QuadGrid::fine);
    EXPECT_EQ(covered(around), 2 * (8 * 6 - 6) + 1);
    for (const Triangle& t : around) EXPECT_FALSE(mixes(corner, t));
    // A pixel without depth takes a half of each of its four quads away; inpainted depth counts as
    // depth.
    DepthImage hole(grid_height_px, grid_width_px, -4.0f);
    hole(3, 5) = 0.0f;
    look_at(hole);
    const std::vector<Triangle> beside = built(QuadGrid::fine);
    EXPECT_EQ(covered(beside), 2 * (8 * 6 - 4) + 4);
    for (const Triangle& t : beside) EXPECT_FALSE(mixes(hole, t));
}

/// Rims have nine vertices for each pixel, the fifth in its middle; two triangles cover a quarter
/// of a quad.
TEST_F(TriangleBuilderTest, BuildsRimsOnTheCutSideOfASurface) {
    DepthImage left(grid_height_px, grid_width_px, 4.0f);
    left.colRange(0, 4) = 2.0f;
    look_at(left);
    const std::vector<Triangle> rims = built_rims();
    // Two quarters to the right of the last column in each of its six quads.
    EXPECT_EQ(rims.size(), 6u * 2 * 2);
    for (const Triangle& t : rims)
        for (const std::uint32_t vertex : t) {
            EXPECT_EQ(column(vertex / 9), 3);
            EXPECT_GE(vertex % 3, 1u);
        }
}

TEST_F(TriangleBuilderTest, BuildsRimsOnBothSidesOfAPostOfOnePixel) {
    DepthImage post(grid_height_px, grid_width_px, 4.0f);
    post.col(4) = 2.0f;
    look_at(post);
    const std::vector<Triangle> rims = built_rims();
    EXPECT_EQ(rims.size(), 6u * 2 * 2 * 2);
    const auto x = [](std::uint32_t vertex) { return static_cast<int>(vertex % 3); };
    const auto y = [](std::uint32_t vertex) { return static_cast<int>(vertex % 9 / 3); };
    for (const Triangle& t : rims) {
        EXPECT_EQ(column(t[0] / 9), 4);
        const int area =
            (x(t[1]) - x(t[0])) * (y(t[2]) - y(t[0])) - (x(t[2]) - x(t[0])) * (y(t[1]) - y(t[0]));
        EXPECT_EQ(area, 1) << "half a quarter, turning as the grid does";
    }
}

TEST_F(TriangleBuilderTest, BuildsNoRimsOnAnUnbrokenSurface) {
    look_at(DepthImage(grid_height_px, grid_width_px, 3.0f));
    EXPECT_TRUE(built_rims().empty());
}

}  // namespace
}  // namespace vantage
