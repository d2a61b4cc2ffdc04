#include "host_app/refine/depth_inpainting.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "common/gl/context/egl_context.h"
#include "common/image/image.h"
#include "tests/support/filled_texture.h"

namespace vantage {
namespace {

const cv::Vec4b red(200, 40, 40, 255), blue(40, 40, 200, 255);

/// The reference of fill_pull.frag: for each window of four by four pixels, the mean inverse depth
/// of those within 5 % of the farthest.
DepthImage pulled(const DepthImage& map) {
    DepthImage half(cv::Size((map.cols + 1) / 2, (map.rows + 1) / 2), 0.0f);
    for (int y = 0; y < half.rows; ++y)
        for (int x = 0; x < half.cols; ++x) {
            std::vector<double> known;
            for (int v = 2 * y - 1; v <= 2 * y + 2; ++v)
                for (int u = 2 * x - 1; u <= 2 * x + 2; ++u) {
                    const double z =
                        map(std::clamp(v, 0, map.rows - 1), std::clamp(u, 0, map.cols - 1));
                    if (z > 0) known.push_back(z);
                }
            if (known.empty()) continue;
            const double farthest = *std::max_element(known.begin(), known.end());
            double inverse = 0, count = 0;
            for (const double z : known)
                if (z >= 0.95 * farthest) inverse += 1 / z, ++count;
            half(y, x) = static_cast<float>(count / inverse);
        }
    return half;
}

/// The reference of pull and push with this many halvings: bilinear in inverse depth, negative
/// where the map is unknown.
DepthImage closed_by_halves(const DepthImage& map, int halvings) {
    if (halvings == 0) return map;
    const DepthImage coarse = closed_by_halves(pulled(map), halvings - 1);
    DepthImage closed = map.clone();
    for (int y = 0; y < map.rows; ++y)
        for (int x = 0; x < map.cols; ++x) {
            if (map(y, x) != 0) continue;
            // The middle of a fine pixel among the middles of coarse ones.
            const double u = 0.5 * x - 0.25, v = 0.5 * y - 0.25;
            double inverse = 0, weights = 0;
            for (int k = 0; k < 4; ++k) {
                const int cu = static_cast<int>(std::floor(u)) + k % 2;
                const int cv = static_cast<int>(std::floor(v)) + k / 2;
                const double w = (1 - std::abs(u - cu)) * (1 - std::abs(v - cv));
                const double z = std::abs(
                    coarse(std::clamp(cv, 0, coarse.rows - 1), std::clamp(cu, 0, coarse.cols - 1)));
                if (z > 0) inverse += w / z, weights += w;
            }
            closed(y, x) = weights > 0 ? static_cast<float>(-weights / inverse) : 0.0f;
        }
    return closed;
}

class DepthInpaintingTest : public testing::Test {
  protected:
    DepthImage closed(const DepthImage& depth_m, const DepthImage& measured_m,
                      const ColourImage& picture) {
        const Texture depth = filled_texture(TextureFormat::r32f, depth_m);
        const Texture measured = filled_texture(TextureFormat::r32f, measured_m);
        const Texture colours = filled_texture(TextureFormat::rgba8, picture, Filter::linear);
        const Texture result(TextureFormat::r32f, depth_m.cols, depth_m.rows);
        inpainting_.close(depth, measured, colours, Framebuffer({&result}));
        return result.download();
    }
    static ColourImage grey(cv::Size size) { return {size, cv::Vec4b(128, 128, 128, 255)}; }

    EglContext context_;
    ShaderLibrary shaders_;
    DepthInpainting inpainting_{shaders_};
};

TEST_F(DepthInpaintingTest, KeepsKnownAndInpaintedDepth) {
    DepthImage map(29, 37, 0.0f);
    cv::RNG random(1);
    for (float& z : map) {
        const int kind = random.uniform(0, 4);
        z = kind == 0 ? 0.0f : (kind == 1 ? -1.0f : 1.0f) * random.uniform(2.0f, 5.0f);
    }
    const DepthImage result = closed(map, map, grey(map.size()));
    for (int y = 0; y < map.rows; ++y)
        for (int x = 0; x < map.cols; ++x) {
            if (map(y, x) != 0)
                EXPECT_EQ(result(y, x), map(y, x)) << x << ' ' << y;
            else
                EXPECT_LT(result(y, x), 0) << x << ' ' << y;
        }
}

/// A hole between a near and a far surface belongs to the one of its colour, or to the far one if
/// it has the colour of neither.
TEST_F(DepthInpaintingTest, InpaintsTheSurfaceOfSimilarColourAndElseTheFarther) {
    const cv::Rect hole(20, 10, 8, 20);
    DepthImage map(40, 48, 4.0f);
    map.colRange(0, 24) = 2.0f;
    map(hole) = 0.0f;
    ColourImage picture(map.size(), blue);
    picture.colRange(0, 24) = red;
    const std::pair<cv::Vec4b, float> wanted[] = {
        {red, -2.0f}, {blue, -4.0f}, {cv::Vec4b(120, 40, 120, 255), -4.0f}};
    for (const auto& [colour, depth_m] : wanted) {
        picture(hole) = colour;
        const DepthImage result = closed(map, map, picture)(hole);
        // Away from the hole's ends, where other directions count.
        const DepthImage inside = result(cv::Rect(2, 6, hole.width - 4, hole.height - 12));
        EXPECT_LT(cv::norm(inside, DepthImage(inside.size(), depth_m), cv::NORM_INF), 1e-4)
            << cv::Mat(cv::Vec4i(colour)).t() << '\n'
            << result;
    }
}

/// The distances that are tried along a direction grow by a half and are rounded: the third pixel
/// counts with a distance of 3.375.
TEST_F(DepthInpaintingTest, WeighsNearerPixelsOfOneSurfaceMore) {
    DepthImage map(1, 5, 0.0f);
    map(0, 0) = 2.0f;
    map(0, 4) = 2.05f;
    const DepthImage result = closed(map, map, grey(map.size()));
    const double near = 1, far = 1 / 3.375;
    EXPECT_NEAR(result(0, 1), -(near + far) / (near / 2.0 + far / 2.05), 1e-4);
    EXPECT_NEAR(result(0, 3), -(near + far) / (far / 2.0 + near / 2.05), 1e-4);
}

/// Carved pixels do not take the depth beside them, whatever their colour.
TEST_F(DepthInpaintingTest, FillsCarvedPixelsByPullAndPush) {
    DepthImage map(41, 67, 0.0f);
    map.colRange(0, 9) = 2.0f;
    map.colRange(50, 67) = 4.0f;
    map(cv::Rect(30, 4, 3, 2)) = 3.0f;
    const DepthImage before(map.size(), 2.0f);
    const DepthImage result = closed(map, before, grey(map.size()));
    const DepthImage wanted = closed_by_halves(map, 6);
    // Floats against doubles.
    EXPECT_LT(cv::norm(result, wanted, cv::NORM_INF), 1e-4);
    EXPECT_GT(cv::norm(result, closed(map, map, grey(map.size())), cv::NORM_INF), 0.1);
}

TEST_F(DepthInpaintingTest, LeavesAnEmptyMapEmpty) {
    const DepthImage nothing(21, 33, 0.0f);
    EXPECT_EQ(cv::countNonZero(closed(nothing, nothing, grey(nothing.size()))), 0);
}

}  // namespace
}  // namespace vantage
