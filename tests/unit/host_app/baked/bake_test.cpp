#include "host_app/baked/bake.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "tests/unit/host_app/fused/wall_and_square.h"

namespace vantage {
namespace {

constexpr int baked_width_px = 96, baked_height_px = 72;
constexpr float baked_wall_m = 4, baked_square_m = 2;

DepthView plain_view(double x_m, double focal_widths = 0.8) {
    DepthView view = wall_and_square(x_m, baked_width_px, baked_height_px, {.square_x_m = 100});
    view.K = intrinsics(focal_widths * baked_width_px, baked_width_px, baked_height_px);
    view.baseline_m = 0.2;
    return view;
}

DepthView view_with_square(double x_m) {
    DepthView view = wall_and_square(x_m, baked_width_px, baked_height_px);
    view.baseline_m = 0.2;
    return view;
}

/// The area of a part's measured surfaces in the world, m^2.
double area_m2(const BakedPart& part, const DepthView& owner) {
    const Eigen::Matrix3d K_inverse = owner.K.inverse();
    const auto point = [&](std::size_t i) {
        return (K_inverse * part.vertices[part.indices[i]].cast<double>()).eval();
    };
    double area = 0;
    for (std::size_t i = 0; i < part.measured; i += 3)
        area += 0.5 * (point(i + 1) - point(i)).cross(point(i + 2) - point(i)).norm();
    return area;
}

double wall_area_m2(const DepthView& view) {
    return baked_wall_m * baked_wall_m * baked_width_px * baked_height_px /
           (view.K(0, 0) * view.K(1, 1));
}

TEST(Bake, MakesAPlaneOfOneRigAFewTrianglesOfItsExactSize) {
    const DepthView view = plain_view(0);
    const BakedBackground baked = *bake_background({&view, 1});
    ASSERT_EQ(baked.parts.size(), 1u);
    const BakedPart& part = baked.parts[0];
    EXPECT_EQ(part.measured, part.indices.size());
    EXPECT_LT(part.indices.size() / 3, 50u);
    EXPECT_NEAR(area_m2(part, view), wall_area_m2(view), 0.01 * wall_area_m2(view));
    for (const Eigen::Vector3f& vertex : part.vertices)
        EXPECT_NEAR(vertex.z(), baked_wall_m, 0.001f);
    EXPECT_EQ(part.sources[0], 0);
    EXPECT_EQ(part.sources[1], -1);
    EXPECT_GT(part.weights(36, 48)[0], 200);
    EXPECT_EQ(part.weights(36, 48)[1], 0);
}

/// The rig with the longer lens has more pixels for each part of the wall that it sees.
TEST(Bake, GivesTheWallThatTwoRigsSeeToTheOneThatSeesItBetter) {
    const std::vector<DepthView> views{plain_view(-0.2, 0.8), plain_view(0.2, 1.6)};
    const BakedBackground baked = *bake_background(views);
    const double wide = area_m2(baked.parts[0], views[0]),
                 close = area_m2(baked.parts[1], views[1]);
    EXPECT_GT(close, 0.9 * wall_area_m2(views[1]));
    // Parts overlap by some pixels along their common outline.
    EXPECT_NEAR(wide + close, wall_area_m2(views[0]), 0.16 * wall_area_m2(views[0]));
    EXPECT_LT(wide + close, wall_area_m2(views[0]) + 0.5 * wall_area_m2(views[1]));
}

TEST(Bake, CutsTheMeshAtDepthEdges) {
    const DepthView view = view_with_square(0);
    const BakedPart part = bake_background({&view, 1})->parts.at(0);
    ASSERT_GT(part.indices.size(), 0u);
    for (std::size_t i = 0; i < part.indices.size(); i += 3) {
        const auto z = [&](std::size_t k) { return part.vertices[part.indices[i + k]].z(); };
        EXPECT_LT(std::max({z(0), z(1), z(2)}), 1.01f * std::min({z(0), z(1), z(2)}));
    }
}

/// The square hides a part of the wall from either rig, to its other side.
TEST(Bake, KnowsWhichRigsAPlaceIsHiddenFrom) {
    const std::vector<DepthView> views{view_with_square(-0.5), view_with_square(0.5)};
    const BakedBackground baked = *bake_background(views);
    const BakedPart& left = baked.parts[0];
    ASSERT_EQ(left.sources[1], 1);
    int hidden = 0, seen = 0;
    for (int y = 2; y < baked_height_px - 2; ++y)
        for (int x = 2; x < baked_width_px - 2; ++x) {
            if (views[0].depth_m(y, x) != baked_wall_m) continue;
            const double wall_x = -0.5 + baked_wall_m * (x - views[0].K(0, 2)) / views[0].K(0, 0);
            const double wall_y = baked_wall_m * (y - views[0].K(1, 2)) / views[0].K(1, 1);
            // Where the second rig's line of sight passes the square's plane, and its place there.
            const double square_x = 0.5 + 0.5 * (wall_x - 0.5), square_y = 0.5 * wall_y;
            const double u = (wall_x - 0.5) / baked_wall_m * views[1].K(0, 0) + views[1].K(0, 2);
            if (u < 2 || u > baked_width_px - 3) continue;
            const double inside = std::max(std::abs(square_x), std::abs(square_y)) - 0.5;
            const int weight = left.weights(y, x)[1];
            if (inside < -0.08) {
                EXPECT_EQ(weight, 0) << x << ' ' << y;
                ++hidden;
            } else if (inside > 0.08) {
                EXPECT_GT(weight, 0) << x << ' ' << y;
                ++seen;
            }
        }
    EXPECT_GT(hidden, 100);
    EXPECT_GT(seen, 1000);
}

/// A matcher's error: a piece of the wall that stands free in the air.
TEST(Bake, LeavesOutASurfaceThatTwoRigsSeeThrough) {
    std::vector<DepthView> views{plain_view(-0.4), plain_view(0), plain_view(0.4)};
    const cv::Rect wrong(40, 30, 12, 10);
    views[1].depth_m(wrong) = 2.5f;
    const BakedBackground baked = *bake_background(views);
    for (const BakedPart& part : baked.parts)
        for (const std::uint32_t index : part.indices) EXPECT_GT(part.vertices[index].z(), 3.9f);
}

TEST(Bake, KeepsASurfaceThatOnlyOneRigSees) {
    std::vector<DepthView> views{view_with_square(0), plain_view(-3)};
    views[1].world_from_camera.linear() =
        Eigen::AngleAxisd(2.5, Eigen::Vector3d::UnitY()).toRotationMatrix();
    const BakedBackground baked = *bake_background(views);
    const auto is_square = [](const Eigen::Vector3f& v) { return v.z() < 2.1f; };
    EXPECT_TRUE(
        std::any_of(baked.parts[0].vertices.begin(), baked.parts[0].vertices.end(), is_square));
}

/// An inpainted depth is drawn where nothing was measured, and only there.
TEST(Bake, PutsInpaintedSurfacesApart) {
    DepthView view = plain_view(0);
    const cv::Rect hole(40, 30, 12, 10);
    view.depth_m(hole) = -baked_wall_m;
    const BakedPart part = bake_background({&view, 1})->parts.at(0);
    ASSERT_LT(part.measured, part.indices.size());
    for (std::size_t i = part.measured; i < part.indices.size(); ++i) {
        const Eigen::Vector3f& v = part.vertices[part.indices[i]];
        EXPECT_GE(v.x() / v.z(), hole.x - 1);
        EXPECT_LE(v.x() / v.z(), hole.x + hole.width);
    }
    EXPECT_NEAR(area_m2(part, view) / wall_area_m2(view),
                1 - static_cast<double>(hole.area()) / (baked_width_px * baked_height_px), 0.01);
    const std::vector<DepthView> views{view, plain_view(0.2)};
    const BakedBackground with_another = *bake_background(views);
    EXPECT_EQ(with_another.parts[0].measured, with_another.parts[0].indices.size());
}

/// Lens and sensor mix the colours of both sides of an edge.
TEST(Bake, TrustsColoursLessBesideDepthEdges) {
    const DepthView view = view_with_square(0);
    const BakedBackground baked = *bake_background({&view, 1});
    const ColourImage& colour = baked.views.at(0).colour;
    ASSERT_EQ(colour.size(), view.colour.size());
    int edge_x = baked_width_px / 2;
    while (view.depth_m(36, edge_x) == baked_square_m) ++edge_x;
    EXPECT_LT(colour(36, edge_x)[3], 20);
    EXPECT_EQ(colour(36, edge_x + 4)[3], 255);
    EXPECT_EQ(colour(36, edge_x)[0], view.colour(36, edge_x)[0]);
}

TEST(Bake, StopsWhenAsked) {
    const DepthView view = plain_view(0);
    std::stop_source stop;
    stop.request_stop();
    EXPECT_FALSE(bake_background({&view, 1}, stop.get_token()));
}

}  // namespace
}  // namespace vantage
