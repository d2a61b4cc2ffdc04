#include "common/gl/sliced_drawing.h"

#include <stdexcept>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "common/gl/context/egl_context.h"
#include "common/gl/fullscreen_pass.h"
#include "tests/unit/common/gl/shader_folder.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;

struct PatternShaders : ShaderFolder {
    PatternShaders() {
        // Every pixel another one, by floating point and by whole numbers; some are left out.
        write("pattern.frag",
              "uniform float phase;\n"
              "layout(location = 0) out vec4 drawn;\n"
              "void main() {\n"
              "  ivec2 at = ivec2(gl_FragCoord.xy);\n"
              "  if ((at.x * 7 + at.y * 13) % 11 == 0) discard;\n"
              "  drawn = fract(vec4(sin(gl_FragCoord.x * 0.37 + phase),\n"
              "                     cos(gl_FragCoord.y * 0.71 - phase),\n"
              "                     float((at.x * at.y) % 251) / 251.0,\n"
              "                     float((at.x ^ at.y) & 255) / 255.0));\n"
              "  gl_FragDepth = fract(gl_FragCoord.x * 0.013 + gl_FragCoord.y * 0.029);\n"
              "}");
        write("flat.frag",
              "layout(location = 0) out vec4 drawn;\n"
              "void main() { drawn = vec4(0.6, 0.2, 0.8, 1.0); }");
    }
};

/// By the length of a slice: bands become as low, or as high, as they may.
class SlicedDrawingTest : public testing::TestWithParam<std::chrono::nanoseconds> {
  protected:
    /// Three pictures, so that the height of the bands changes: a pattern that writes depth, and a
    /// flat colour where depth is less than a half.
    cv::Mat drawn(cv::Size size) {
        const Texture colour(TextureFormat::rgba8, size.width, size.height);
        const Texture depth(TextureFormat::depth24, size.width, size.height);
        const Framebuffer target({&colour}, &depth);
        target.bind();
        const float grey[4] = {0.3f, 0.3f, 0.3f, 0.3f};
        glClearBufferfv(GL_COLOR, 0, grey);
        for (int i = 0; i < 3; ++i) {
            pattern_.use().set("phase", 0.1f * static_cast<float>(i));
            pattern_.draw_depth(target);
        }
        flat_.use();
        flat_.draw_where(target, GL_GREATER, 0.5f, false);
        return colour.download();
    }

    EglContext context_;
    PatternShaders folder_;
    ShaderLibrary library_{folder_.path()};
    FullscreenPass pattern_{library_, "pattern.frag"}, flat_{library_, "flat.frag"};
};

TEST_P(SlicedDrawingTest, DrawsBitForBitWhatOneDrawDoes) {
    for (const cv::Size size :
         {cv::Size(1, 1), {97, 7}, {33, 8}, {31, 9}, {5, 32}, {127, 33}, {161, 255}, {3, 641}}) {
        const cv::Mat whole = drawn(size);
        const SlicedDrawing slices(GetParam());
        const cv::Mat in_bands = drawn(size);
        EXPECT_EQ(cv::norm(whole, in_bands, cv::NORM_INF), 0) << size;
    }
}

INSTANTIATE_TEST_SUITE_P(Slices, SlicedDrawingTest, testing::Values(1ns, 4ms, 10s));

class BandsTest : public testing::Test {
  protected:
    /// The bands of a pass over so many rows, as the scissor says at every draw.
    std::vector<cv::Rect> bands(int height, int& rows, const SlicedDrawing& slices) {
        std::vector<cv::Rect> seen;
        slices.draw({20, height}, rows, [&] {
            EXPECT_TRUE(glIsEnabled(GL_SCISSOR_TEST));
            GLint box[4];
            glGetIntegerv(GL_SCISSOR_BOX, box);
            seen.emplace_back(box[0], box[1], box[2], box[3]);
        });
        return seen;
    }

    EglContext context_;
};

TEST_F(BandsTest, CoverEveryRowOnceAndLeaveNoScissor) {
    const SlicedDrawing slices(1ns);
    int rows = 0;
    for (const int height : {1, 7, 32, 33, 211}) {
        int next = 0;
        for (const cv::Rect& band : bands(height, rows, slices)) {
            EXPECT_EQ(band.x, 0);
            EXPECT_EQ(band.width, 20);
            EXPECT_EQ(band.y, next);
            EXPECT_GT(band.height, 0);
            next += band.height;
        }
        EXPECT_EQ(next, height);
        EXPECT_FALSE(glIsEnabled(GL_SCISSOR_TEST));
    }
}

TEST_F(BandsTest, GrowAndShrinkToFillTheSlice) {
    int rows = 0;
    {
        const SlicedDrawing slices(1h);
        for (int i = 0; i < 20; ++i) bands(500, rows, slices);
        EXPECT_EQ(bands(500, rows, slices).size(), 1u);
    }
    const SlicedDrawing slices(1ns);
    for (int i = 0; i < 20; ++i) bands(500, rows, slices);
    EXPECT_GE(bands(500, rows, slices).size(), 500u / 9);
}

TEST_F(BandsTest, EndOnAnExceptionBetweenBands) {
    int calls = 0, rows = 8;
    const SlicedDrawing slices(1ns, nullptr, [&] {
        if (++calls == 4) throw std::runtime_error("enough");
    });
    int drawn = 0;
    EXPECT_THROW(slices.draw({20, 500}, rows, [&] { ++drawn; }), std::runtime_error);
    EXPECT_EQ(drawn, 3);
    EXPECT_FALSE(glIsEnabled(GL_SCISSOR_TEST));
}

TEST_F(BandsTest, WaitForOthersOnlyWithinTheirShareOfTime) {
    RenderPriority way;
    const RenderPriority::Claim never_ends(way);
    const SlicedDrawing slices(
        1ns, &way, [] {}, 1.0);
    int rows = 8, drawn = 0;
    const auto start = std::chrono::steady_clock::now();
    slices.draw({20, 8 * 1000}, rows, [&] { ++drawn; });
    EXPECT_EQ(drawn, 1000);
    // Waiting for each as long as it may last would take a minute.
    EXPECT_LT(std::chrono::steady_clock::now() - start, 30s);
}

TEST_F(BandsTest, BelongToTheThreadAndToTheInnermostOne) {
    EXPECT_EQ(SlicedDrawing::current(), nullptr);
    const SlicedDrawing outer(4ms);
    EXPECT_EQ(SlicedDrawing::current(), &outer);
    {
        const SlicedDrawing inner(1ms);
        EXPECT_EQ(SlicedDrawing::current(), &inner);
    }
    EXPECT_EQ(SlicedDrawing::current(), &outer);
    std::thread([] { EXPECT_EQ(SlicedDrawing::current(), nullptr); }).join();
}

}  // namespace
}  // namespace vantage
