#include "host_app/instants/edge_trust.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "common/gl/egl_context.h"
#include "tests/unit/synthesis/wall_and_square.h"

namespace vantage {
namespace {

class EdgeTrustTest : public testing::Test {
  protected:
    ColourImage judged(const DepthView& view) {
        RigSurface surface;
        std::unique_ptr<ColourCorrector> corrector;
        std::unique_ptr<DepthUploader> uploader;
        surface.upload(view, corrector, uploader);
        Texture picture(TextureFormat::rgba8, view.colour.cols, view.colour.rows, Filter::linear);
        picture.upload(view.colour);
        trust_.judge(picture, surface);
        return surface.colour().download();
    }
    static DepthView noise(cv::Size size, uchar alpha) {
        DepthView view;
        view.colour = ColourImage(size);
        cv::RNG random(1);
        random.fill(view.colour, cv::RNG::UNIFORM, 0, 256);
        for (cv::Vec4b& c : view.colour) c[3] = alpha;
        return view;
    }

    EglContext context_;
    ShaderLibrary shaders_;
    EdgeTrust trust_{shaders_};
};

/// Of 255, by the distance to the nearest pixel of another surface: a fiftieth beside it, all from
/// three pixels on, and between them the square of the way.
int trust_at(double away_px) {
    const double way = (std::min(away_px, 3.0) - 1) / 2;
    return static_cast<int>(std::lround(255 * (0.02 + 0.98 * way * way)));
}

TEST_F(EdgeTrustTest, GrowsWithTheDistanceFromADepthEdge) {
    DepthView view = noise({41, 29}, 255);
    view.depth_m = DepthImage(view.colour.size(), 4.0f);
    // Guessed depth is as much a surface; no depth is another one.
    view.depth_m(cv::Rect(10, 8, 9, 7)) = -2.0f;
    view.depth_m(20, 33) = 0.0f;
    // A slope that is none.
    view.depth_m.colRange(0, 4) = 3.9f;
    const ColourImage result = judged(view);
    const auto is_other = [&](int x, int y, int u, int v) {
        const float a = std::abs(view.depth_m(y, x)), b = std::abs(view.depth_m(v, u));
        return std::max(a, b) > 1.04f * std::min(a, b);
    };
    int edges = 0;
    for (int y = 0; y < view.colour.rows; ++y)
        for (int x = 0; x < view.colour.cols; ++x) {
            double nearest = 100;
            for (int v = std::max(y - 2, 0); v <= std::min(y + 2, view.colour.rows - 1); ++v)
                for (int u = std::max(x - 2, 0); u <= std::min(x + 2, view.colour.cols - 1); ++u)
                    if (is_other(x, y, u, v)) nearest = std::min(nearest, std::hypot(u - x, v - y));
            EXPECT_NEAR(result(y, x)[3], trust_at(nearest), 1) << x << ' ' << y;
            edges += nearest < 3;
            for (int c = 0; c < 3; ++c) EXPECT_EQ(result(y, x)[c], view.colour(y, x)[c]);
        }
    EXPECT_GT(edges, 100);
}

TEST_F(EdgeTrustTest, IsAShareOfWhatThePictureHasThere) {
    DepthView view = noise({16, 1}, 128);
    view.depth_m = DepthImage(view.colour.size(), 2.0f);
    view.depth_m.colRange(8, 16) = 3.0f;
    const ColourImage result = judged(view);
    for (int x = 0; x < 16; ++x)
        EXPECT_NEAR(result(0, x)[3], 128 * trust_at(x < 8 ? 8 - x : x - 7) / 255.0, 1) << x;
}

/// A pixel of the map spans two of the picture.
TEST_F(EdgeTrustTest, CountsPixelsOfThePictureWhateverTheMapsSize) {
    DepthView view = noise({32, 2}, 255);
    view.depth_m = DepthImage(1, 16, 2.0f);
    view.depth_m.colRange(8, 16) = 3.0f;
    const ColourImage result = judged(view);
    for (int x = 0; x < 32; ++x)
        EXPECT_NEAR(result(0, x)[3], trust_at(x < 16 ? 16 - x : x - 15), 1) << x;
}

}  // namespace
}  // namespace vantage
