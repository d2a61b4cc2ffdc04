#include <cmath>

#include <gtest/gtest.h>

#include "host_app/baked/background_probe.h"

namespace vantage {
namespace {

constexpr int map_width_px = 64, map_height_px = 48;
constexpr float tile_tolerance = 0.002f;

/// A floor that rises towards the viewer below the middle, before a wall.
DepthImage floor_and_wall() {
    DepthImage depth_m(map_height_px, map_width_px, 4.0f);
    for (int y = map_height_px / 2; y < map_height_px; ++y)
        for (int x = 0; x < map_width_px; ++x)
            depth_m(y, x) = 1 / (0.25f + 0.01f * static_cast<float>(y - map_height_px / 2));
    return depth_m;
}

/// Inverse depth of a tile's plane at a place.
float plane_at(const DepthTile& tile, float u, float v) {
    const TileCorner &a = tile.corners[0], &d = tile.corners[3];
    const float across = (u - a.u_px) / (d.u_px - a.u_px), down = (v - a.v_px) / (d.v_px - a.v_px);
    return a.inverse_depth + across * (tile.corners[1].inverse_depth - a.inverse_depth) +
           down * (tile.corners[2].inverse_depth - a.inverse_depth);
}

/// The least distance of a pixel's inverse depth from a tile that covers it, 1/m.
float miss(std::span<const DepthTile> tiles, const DepthImage& depth_m, int x, int y) {
    float least = 1e9f;
    const auto u = static_cast<float>(x), v = static_cast<float>(y);
    for (const DepthTile& tile : tiles) {
        const TileCorner &a = tile.corners[0], &d = tile.corners[3];
        if (u < a.u_px || u > d.u_px || v < a.v_px || v > d.v_px) continue;
        least = std::min(least, std::abs(plane_at(tile, u, v) - 1 / depth_m(y, x)));
    }
    return least;
}

TEST(DepthTiles, LieOnTheSurfacesOfEveryPixel) {
    const DepthImage depth_m = floor_and_wall();
    const std::vector<DepthTile> tiles = planar_tiles(depth_m, tile_tolerance);
    for (int y = 0; y < map_height_px; ++y)
        for (int x = 0; x < map_width_px; ++x)
            ASSERT_LE(miss(tiles, depth_m, x, y), tile_tolerance) << x << ", " << y;
}

TEST(DepthTiles, ArePlanesNotPixels) {
    EXPECT_LE(planar_tiles(floor_and_wall(), tile_tolerance).size(), 24u);
}

TEST(DepthTiles, KeepTwoSurfacesOfABlockApart) {
    DepthImage depth_m(map_height_px, map_width_px, 4.0f);
    depth_m(cv::Rect(20, 10, 5, 30)) = 2;
    for (const DepthTile& tile : planar_tiles(depth_m, tile_tolerance))
        for (const TileCorner& corner : tile.corners)
            EXPECT_LE(std::min(std::abs(corner.inverse_depth - 0.25f),
                               std::abs(corner.inverse_depth - 0.5f)),
                      tile_tolerance);
}

TEST(DepthTiles, OfNothingAreNone) {
    const DepthImage nothing(map_height_px, map_width_px, 0.0f);
    EXPECT_TRUE(planar_tiles(nothing, tile_tolerance).empty());
    EXPECT_TRUE(backdrop_tiles(nothing, 8).empty());
}

TEST(DepthTiles, BackdropHasNoHolesAndStandsBehind) {
    DepthImage depth_m = floor_and_wall();
    depth_m(cv::Rect(16, 8, 24, 24)) = 0;
    const std::vector<DepthTile> tiles = backdrop_tiles(depth_m, 8);
    ASSERT_EQ(tiles.size(), 8u * 6u);
    for (const DepthTile& tile : tiles)
        for (const TileCorner& corner : tile.corners) {
            EXPECT_GT(corner.inverse_depth, 0);
            EXPECT_LE(corner.inverse_depth, 0.5f);
        }
}

ProbeTiles tiles_of(const ColourImage& colour, const DepthImage& depth_m, double parallax_px_m) {
    return probe_tiles({map_width_px, map_height_px},
                       {depth_m, colour, cv::Mat4b(depth_m.size(), cv::Vec4b()), {}},
                       parallax_px_m);
}

TEST(ProbeTiles, FillPlacesWithoutASurfaceAndKeepSmallThings) {
    DepthImage depth_m(map_height_px, map_width_px, 4.0f);
    ColourImage colour(depth_m.size(), cv::Vec4b(90, 90, 90, 255));
    depth_m(cv::Rect(10, 10, 3, 3)) = 2;
    depth_m(cv::Rect(40, 20, 8, 8)) = 0;
    colour(cv::Rect(40, 20, 8, 8)) = cv::Vec4b(0, 0, 0, 0);
    constexpr double parallax_px_m = 100;
    const ProbeTiles probe = tiles_of(colour, depth_m, parallax_px_m);
    EXPECT_FLOAT_EQ(probe.inverse_depth(24, 44), 0.25f);
    EXPECT_EQ(probe.colour(24, 44)[0], 90);
    EXPECT_LT(probe.colour(24, 44)[3], 128) << "it is as if it had been seen";
    EXPECT_FLOAT_EQ(probe.inverse_depth(11, 11), 0.5f) << "a thing of 3x3 pixels";
    EXPECT_FLOAT_EQ(probe.inverse_depth(40, 10), 0.25f);
    EXPECT_EQ(probe.colour(40, 10)[3], 255);
}

TEST(ProbeTiles, ContinueTheFartherSurfaceIntoAHole) {
    DepthImage depth_m(map_height_px, map_width_px, 4.0f);
    depth_m(cv::Rect(0, 0, 28, map_height_px)) = 2;
    depth_m(cv::Rect(28, 0, 8, map_height_px)) = 0;
    const ColourImage colour(depth_m.size(), cv::Vec4b(90, 90, 90, 255));
    const ProbeTiles probe = tiles_of(colour, depth_m, 100);
    // Each side meets a half of it; there the farther one prevails.
    EXPECT_FLOAT_EQ(probe.inverse_depth(20, 33), 0.25f);
    EXPECT_FLOAT_EQ(probe.inverse_depth(20, 27), 0.5f);
    DepthImage wide = depth_m.clone();
    wide(cv::Rect(28, 0, map_width_px - 28, map_height_px)) = 0;
    EXPECT_EQ(tiles_of(colour, wide, 100).inverse_depth(20, map_width_px - 2), 0)
        << "what is far from all surfaces is left to the backdrop";
}

ProbeRig probe_rig_at(double x_m) {
    Eigen::Matrix3d K;
    K << 100, 0, 79.5, 0, 100, 59.5, 0, 0, 1;
    Pose pose = Pose::Identity();
    pose.translate(Eigen::Vector3d(x_m, 0, 0));
    return {K, pose, {160, 120}};
}

TEST(ProbePlacement, PutsProbesAtRigsAndBetweenNeighbours) {
    const std::vector<ProbeRig> rigs{probe_rig_at(0), probe_rig_at(1), probe_rig_at(2)};
    std::vector<double> places;
    for (const VirtualView& view : probe_views(rigs))
        places.push_back(view.world_from_camera.translation().x());
    std::sort(places.begin(), places.end());
    EXPECT_EQ(places, (std::vector<double>{0, 0.5, 1, 1.5, 2}));
    EXPECT_NEAR(largest_parallax_px_m(probe_views(rigs)), 0.25 * 1.25 * 100, 1e-6);
}

TEST(ProbePlacement, SeesMoreThanTheRig) {
    const std::vector<ProbeRig> rigs{probe_rig_at(0)};
    const VirtualView probe = probe_views(rigs).at(0);
    const double half_field = 80.0 / 100;
    EXPECT_GT(0.5 * probe.width_px / probe.K(0, 0), 1.1 * half_field);
}

TEST(ProbePlacement, CountsAWayAheadLessThanOneAside) {
    VirtualView probe, ahead, aside;
    ahead.world_from_camera.translate(Eigen::Vector3d(0, 0, 1));
    aside.world_from_camera.translate(Eigen::Vector3d(1, 0, 0));
    EXPECT_LT(way_m(probe, ahead), 0.5 * way_m(probe, aside));
}

}  // namespace
}  // namespace vantage
