#include "host_app/refine/edge_confidence.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "common/gl/context/egl_context.h"
#include "tests/unit/host_app/fused/wall_and_square.h"
#include "tests/unit/host_app/surfaces/drawn_by.h"

namespace vantage {
namespace {

class EdgeConfidenceTest : public testing::Test {
  protected:
    cv::Mat1b judged(const DepthView& view) {
        RigSurface surface;
        std::unique_ptr<ColourCorrector> corrector;
        std::unique_ptr<DepthUploader> uploader;
        surface.upload(view, corrector, uploader);
        confidence_.judge(surface);
        return surface.confidence().texture().download();
    }
    static DepthView picture(cv::Size size) {
        DepthView view;
        view.colour = ColourImage(size, cv::Vec4b(0, 0, 0, 255));
        return view;
    }

    EglContext context_;
    ShaderLibrary shaders_;
    EdgeConfidence confidence_{shaders_};
};

/// The confidence (0..255) at a distance from the nearest pixel of another surface: 2 % beside it,
/// 100 % from three pixels on, and quadratic between them.
int confidence_at(double away_px) {
    const double way = (std::min(away_px, 3.0) - 1) / 2;
    return static_cast<int>(std::lround(255 * (0.02 + 0.98 * way * way)));
}

TEST_F(EdgeConfidenceTest, GrowsWithTheDistanceFromADepthEdge) {
    DepthView view = picture({41, 29});
    view.depth_m = DepthImage(view.colour.size(), 4.0f);
    // Inpainted depth is a surface too; a pixel without depth counts as another surface.
    view.depth_m(cv::Rect(10, 8, 9, 7)) = -2.0f;
    view.depth_m(20, 33) = 0.0f;
    // A step that is too small for an edge.
    view.depth_m.colRange(0, 4) = 3.9f;
    const cv::Mat1b confidence = judged(view);
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
            EXPECT_NEAR(confidence(y, x), confidence_at(nearest), 1) << x << ' ' << y;
            edges += nearest < 3;
        }
    EXPECT_GT(edges, 100);
}

/// Both where the background is visible and where foreground with a low matte hides it.
TEST_F(EdgeConfidenceTest, ScalesTheConfidenceOfTheBackgroundsColours) {
    cv::Mat1b confidence(2, 8);
    for (int x = 0; x < 8; ++x) confidence.col(x) = 36 * x;
    ColourImage colours(confidence.size());
    cv::RNG random(1);
    random.fill(colours, cv::RNG::UNIFORM, 0, 256);
    FullscreenPass pass(shaders_, "colours_now.frag");
    const Texture target(TextureFormat::rgba8, 8, 2);
    const Texture trusted = texture_of(TextureFormat::r8, confidence);
    const Texture matte = texture_of(TextureFormat::r8, cv::Mat1b(confidence.size(), uchar{50}));
    const Texture performers = texture_of(TextureFormat::r32f, DepthImage(confidence.size(), 2.0f));
    const Texture behind = texture_of(TextureFormat::r32f, DepthImage(confidence.size(), 4.0f));
    for (const int counts : {255, 128, 4}) {
        for (cv::Vec4b& c : colours) c[3] = static_cast<uchar>(counts);
        const Texture background = texture_of(TextureFormat::rgba8, colours);
        Program& program = pass.use();
        program.input("background_colour", background);
        program.input("picture", background);
        program.input("seen", matte);
        program.input("matte", matte);
        program.input("performers", performers);
        program.input("background_depth", behind);
        program.input("confidence", trusted);
        const ColourImage now = drawn_by(pass, target);
        for (int y = 0; y < now.rows; ++y)
            for (int x = 0; x < now.cols; ++x) {
                for (int c = 0; c < 3; ++c) EXPECT_EQ(now(y, x)[c], colours(y, x)[c]);
                EXPECT_NEAR(now(y, x)[3], std::max(counts * confidence(y, x) / 255.0, 1.0), 1);
                EXPECT_GE(now(y, x)[3], 1) << "never 0";
            }
    }
}

/// A pixel of the map spans two of the picture.
TEST_F(EdgeConfidenceTest, CountsPixelsOfThePictureNotOfTheMap) {
    DepthView view = picture({32, 2});
    view.depth_m = DepthImage(1, 16, 2.0f);
    view.depth_m.colRange(8, 16) = 3.0f;
    const cv::Mat1b confidence = judged(view);
    for (int x = 0; x < 32; ++x)
        EXPECT_NEAR(confidence(0, x), confidence_at(x < 16 ? 16 - x : x - 15), 1) << x;
}

}  // namespace
}  // namespace vantage
