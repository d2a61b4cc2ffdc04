#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "common/gl/context/egl_context.h"
#include "common/gl/tile_pass.h"
#include "host_app/surfaces/rig_surface.h"

namespace vantage {
namespace {

constexpr int blocks_width_px = 65, blocks_height_px = 49;
constexpr float spread = 0.005f;

class FlatBlocksTest : public testing::Test {
  protected:
    using Triangle = std::array<cv::Point, 3>;

    void fill(const std::function<float(int, int)>& depth_m) {
        cv::Mat1f map(blocks_height_px, blocks_width_px);
        for (int y = 0; y < blocks_height_px; ++y)
            for (int x = 0; x < blocks_width_px; ++x) map(y, x) = depth_m(x, y);
        map_.upload(map);
    }

    DepthGrid grid(QuadGrid quads) const {
        Eigen::Matrix3d K;
        K << 60, 0, 32, 0, 60, 24, 0, 0, 1;
        return {map_, triangles_, K, Pose::Identity(), quads, spread};
    }

    /// The triangles that were built, with corners in pixels of the depth map.
    std::vector<Triangle> built() const {
        std::array<std::uint32_t, 5> command{};
        triangles_.command.read(0, std::as_writable_bytes(std::span(command)));
        EXPECT_EQ(command[0] % 3, 0u);
        EXPECT_LE(static_cast<int>(command[0]), triangles_.capacity);
        std::vector<std::uint32_t> indices(command[0]);
        triangles_.indices.read(0, std::as_writable_bytes(std::span(indices)));
        std::vector<Triangle> triangles;
        const auto pixel = [](std::uint32_t index) {
            return cv::Point(static_cast<int>(index) % blocks_width_px,
                             static_cast<int>(index) / blocks_width_px);
        };
        for (std::size_t i = 0; i < indices.size(); i += 3)
            triangles.push_back({pixel(indices[i]), pixel(indices[i + 1]), pixel(indices[i + 2])});
        return triangles;
    }

    static double doubled_area(const Triangle& t) { return (t[1] - t[0]).cross(t[2] - t[0]); }

    EglContext context_;
    ShaderLibrary shaders_;
    TriangleBuilder builder_{shaders_};
    Texture map_{TextureFormat::r32f, blocks_width_px, blocks_height_px};
    IndirectTriangles triangles_{triangle_indices({blocks_width_px, blocks_height_px})};
};

TEST_F(FlatBlocksTest, AreTwoTriangles) {
    // A slanted plane: inverse depth is linear in the picture.
    fill([](int x, int y) {
        return 1 / (0.4f + 0.002f * static_cast<float>(x) + 0.001f * static_cast<float>(y));
    });
    builder_.build(grid(QuadGrid::coarse));
    constexpr int blocks = 8 * 6;
    EXPECT_EQ(built().size(), 2u * blocks);
    double area = 0;
    for (const Triangle& triangle : built()) area += std::abs(doubled_area(triangle)) / 2;
    EXPECT_GE(area, (blocks_width_px - 1) * (blocks_height_px - 1));
}

TEST_F(FlatBlocksTest, WithABumpInOneQuarterKeepTheOtherQuartersFlat) {
    const auto plane = [](int x, int y) {
        return 1 / (0.4f + 0.002f * static_cast<float>(x) + 0.001f * static_cast<float>(y));
    };
    // A bump at the corner of a quarter, so that it touches three other blocks.
    fill([&](int x, int y) {
        const bool is_bump = x >= 25 && x <= 26 && y >= 17 && y <= 18;
        return plane(x, y) * (is_bump ? 0.985f : 1.0f);
    });
    builder_.build(grid(QuadGrid::coarse));
    constexpr std::size_t blocks = 8 * 6, bent = 4, quads = 4;
    EXPECT_GT(built().size(), 2 * blocks) << "the bump must not be flattened";
    EXPECT_LE(built().size(), 2 * (blocks - bent) + bent * 2 * (3 + quads));
    builder_.build(grid(QuadGrid::coarse), 5 * TriangleBuilder::default_bend);
    EXPECT_EQ(built().size(), 2 * blocks) << "the bump is below this bend";
    builder_.build(grid(QuadGrid::coarse));
    double area = 0;
    for (const Triangle& triangle : built()) area += std::abs(doubled_area(triangle)) / 2;
    EXPECT_GE(area, (blocks_width_px - 1) * (blocks_height_px - 1));
}

TEST_F(FlatBlocksTest, DoNotSpanARidge) {
    // A ridge down the picture: half of all blocks touch it or their neighbours do.
    fill([](int x, int) {
        return 1 / (0.4f - 0.004f * static_cast<float>(std::abs(x - blocks_width_px / 2)));
    });
    builder_.build(grid(QuadGrid::coarse));
    for (const Triangle& triangle : built()) {
        const auto [left, right] = std::minmax({triangle[0].x, triangle[1].x, triangle[2].x});
        EXPECT_FALSE(left < blocks_width_px / 2 - 1 && right > blocks_width_px / 2 + 1)
            << left << " to " << right;
    }
}

TEST_F(FlatBlocksTest, AreBuiltOnlyInSelectedTiles) {
    fill([](int, int) { return 2.0f; });
    const cv::Size picture(blocks_width_px, blocks_height_px), count = TilePass::tiles_of(picture);
    cv::Mat1b tiles = cv::Mat1b::zeros(count);
    tiles(1, 2) = 255;
    Texture on(TextureFormat::r8, count.width, count.height);
    on.upload(tiles);
    builder_.build_where(grid(QuadGrid::coarse), on, picture);
    EXPECT_EQ(built().size(), 2u * 4);
    const cv::Rect tile(2 * TilePass::side_px - 1, TilePass::side_px - 1, TilePass::side_px + 3,
                        TilePass::side_px + 3);
    for (const Triangle& triangle : built())
        for (const cv::Point& corner : triangle) EXPECT_TRUE(tile.contains(corner)) << corner;
}

}  // namespace
}  // namespace vantage
