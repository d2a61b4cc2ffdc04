#include "common/gl/fullscreen_pass.h"

#include <gtest/gtest.h>

#include "common/gl/context/egl_context.h"
#include "tests/unit/common/gl/shader_folder.h"

namespace vantage {
namespace {

constexpr int pass_width_px = 21, pass_height_px = 7;
constexpr uchar cleared = 0, first = 100, second = 200;

struct PassShaders : ShaderFolder {
    PassShaders() {
        write("thirds.frag",
              "void main() { gl_FragDepth = 0.2 + 0.3 * float(int(gl_FragCoord.x) % 3); }");
        write("tone.frag",
              "uniform float tone;\nuniform float rows;\n"
              "layout(location = 0) out float drawn;\n"
              "void main() { if (gl_FragCoord.y > rows) discard; drawn = tone; }");
    }
};

/// A picture with a depth texture whose columns stand at 0.2, 0.5 and 0.8 in turn.
class FullscreenPassTest : public testing::Test {
  protected:
    FullscreenPassTest() {
        FullscreenPass thirds(library_, "thirds.frag");
        thirds.use();
        thirds.draw_depth(depth_only_);
        target_.bind();
        const float nothing[4] = {0, 0, 0, 0};
        glClearBufferfv(GL_COLOR, 0, nothing);
    }

    void draw_where(GLenum comparison, float depth, bool writes, uchar tone,
                    int rows = pass_height_px) {
        Program& program = pass_.use();
        program.set("tone", static_cast<float>(tone) / 255);
        program.set("rows", static_cast<float>(rows));
        pass_.draw_where(target_, comparison, depth, writes);
    }
    cv::Mat1b picture() const { return colour_.download(); }

    EglContext context_;
    PassShaders folder_;
    ShaderLibrary library_{folder_.path()};
    Texture colour_{TextureFormat::r8, pass_width_px, pass_height_px};
    Texture depth_{TextureFormat::depth24, pass_width_px, pass_height_px};
    Framebuffer depth_only_ = Framebuffer({}, &depth_);
    Framebuffer target_ = Framebuffer({&colour_}, &depth_);
    FullscreenPass pass_{library_, "tone.frag"};
};

TEST_F(FullscreenPassTest, DrawsOnlyWhereTheDepthComparesAsAsked) {
    draw_where(GL_LESS, 0.65f, false, first);      // before those at 0.8
    draw_where(GL_GREATER, 0.35f, false, second);  // behind those at 0.2
    const cv::Mat1b drawn = picture();
    for (int x = 0; x < pass_width_px; ++x)
        EXPECT_EQ(drawn(pass_height_px / 2, x), x % 3 == 0   ? second
                                                : x % 3 == 1 ? cleared
                                                             : first)
            << "column " << x;
}

TEST_F(FullscreenPassTest, DepthWritesExcludePixelsFromLaterPasses) {
    constexpr int rows = 3;
    draw_where(GL_GREATER, 0.4f, true, first, rows);
    draw_where(GL_GREATER, 0.3f, false, second);
    const cv::Mat1b drawn = picture();
    for (int y = 0; y < pass_height_px; ++y)
        EXPECT_EQ(drawn(y, 3), y < rows ? first : second) << "what was discarded is still there";
    EXPECT_EQ(drawn(0, 4), cleared);
}

TEST_F(FullscreenPassTest, RestoresTheDepthRange) {
    draw_where(GL_GREATER, 0.4f, true, first);
    GLfloat range[2];
    glGetFloatv(GL_DEPTH_RANGE, range);
    EXPECT_EQ(range[0], 0);
    EXPECT_EQ(range[1], 1);
    pass_.draw(target_);
    EXPECT_EQ(cv::countNonZero(picture() != first), 0) << "draw() goes by no depth";
}

}  // namespace
}  // namespace vantage
