#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "common/gl/context/egl_context.h"
#include "common/gl/fullscreen_pass.h"
#include "common/image/image.h"
#include "host_app/views/tolerances.h"
#include "tests/support/filled_texture.h"

namespace vantage {
namespace {

/// The bilinear colour at (x, y) px from the corner of the picture, clamped at the edges.
Eigen::Vector3d colour_at(const ColourImage& picture, double x, double y) {
    const double u = x - 0.5, v = y - 0.5;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (int k = 0; k < 4; ++k) {
        const int cu = static_cast<int>(std::floor(u)) + k % 2;
        const int cv = static_cast<int>(std::floor(v)) + k / 2;
        const cv::Vec4b& c =
            picture(std::clamp(cv, 0, picture.rows - 1), std::clamp(cu, 0, picture.cols - 1));
        sum += (1 - std::abs(u - cu)) * (1 - std::abs(v - cv)) * Eigen::Vector3d(c[0], c[1], c[2]) /
               255;
    }
    return sum;
}

/// The reference of rig_smooth.frag: the mean inverse depth of every other pixel of a window that
/// lies on the surface of the first known one of `scale` x `scale` pixels, weighted by colour.
float smoothed_at(const DepthImage& map, const ColourImage& picture, cv::Point at, int scale) {
    constexpr int reach = 2;
    const cv::Point first = scale * at;
    float own = 0;
    for (int k = 0; k < scale * scale && own <= 0; ++k)
        own = map(std::min(first.y + k / scale, map.rows - 1),
                  std::min(first.x + k % scale, map.cols - 1));
    if (own <= 0) return 0;
    const Eigen::Vector3d middle = colour_at(picture, first.x + 0.5 * scale, first.y + 0.5 * scale);
    double sum = 0, weights = 0;
    for (int y = std::max(first.y - reach, 0);
         y <= std::min(first.y + reach + scale - 1, map.rows - 1); y += 2)
        for (int x = std::max(first.x - reach, 0);
             x <= std::min(first.x + reach + scale - 1, map.cols - 1); x += 2) {
            const float z = map(y, x);
            if (std::max(z, own) > std::min(z, own) * depth_edge_ratio) continue;
            const double off = (colour_at(picture, x + 0.5, y + 0.5) - middle).cwiseAbs().mean();
            const double w = std::exp(-off / static_cast<double>(smoothing_colour_falloff)) + 1e-4;
            sum += w / z;
            weights += w;
        }
    return weights > 0 ? static_cast<float>(weights / sum) : own;
}

class DepthSmoothingTest : public testing::TestWithParam<int> {
  protected:
    DepthSmoothingTest() : map_(27, 35), picture_(27, 35) {
        cv::RNG random(5);
        for (int y = 0; y < map_.rows; ++y)
            for (int x = 0; x < map_.cols; ++x) {
                const bool is_near = x + y < 30;
                map_(y, x) =
                    static_cast<float>((is_near ? 2 : 3) * (1 + random.uniform(-0.01, 0.01)));
                const int tone = random.uniform(0, 40) + (is_near ? 60 : 140);
                picture_(y, x) =
                    cv::Vec4b(static_cast<uchar>(tone), static_cast<uchar>(tone / 2), 90, 255);
                if (random.uniform(0, 9) == 0) map_(y, x) = 0;
            }
    }
    DepthImage drawn(int scale) {
        const Texture map = filled_texture(TextureFormat::r32f, map_);
        const Texture picture = filled_texture(TextureFormat::rgba8, picture_, Filter::linear);
        const Texture result(TextureFormat::r32f, (map_.cols + scale - 1) / scale,
                             (map_.rows + scale - 1) / scale);
        FullscreenPass pass(shaders_, "rig_smooth.frag", {{"SCALE", std::to_string(scale)}});
        Program& program = pass.use();
        program.input("depth_map", map);
        program.input("picture", picture);
        pass.draw(Framebuffer({&result}));
        return result.download();
    }

    EglContext context_;
    ShaderLibrary shaders_;
    DepthImage map_;
    ColourImage picture_;
};

TEST_P(DepthSmoothingTest, MatchesTheReference) {
    const DepthImage result = drawn(GetParam());
    for (int y = 0; y < result.rows; ++y)
        for (int x = 0; x < result.cols; ++x) {
            const float wanted = smoothed_at(map_, picture_, {x, y}, GetParam());
            // A filtered colour may be rounded to 8 bits; depths differ by 2 %.
            EXPECT_NEAR(result(y, x), wanted, 3e-4 * wanted) << x << ' ' << y;
        }
}

TEST_P(DepthSmoothingTest, KeepsAPixelThatIsAloneOnItsSurface) {
    map_ = 0;
    map_(13, 17) = 2;
    const DepthImage result = drawn(GetParam());
    EXPECT_FLOAT_EQ(result(13 / GetParam(), 17 / GetParam()), 2);
    EXPECT_EQ(cv::countNonZero(result), 1);
}

INSTANTIATE_TEST_SUITE_P(ToTheSameSizeAndToHalf, DepthSmoothingTest, testing::Values(1, 2));

}  // namespace
}  // namespace vantage
