#include "common/gl/two_stage_pass.h"

#include <gtest/gtest.h>

#include "common/gl/context/egl_context.h"
#include "common/gl/sliced_drawing.h"
#include "tests/unit/common/gl/shader_folder.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;

struct StripedShaders : ShaderFolder {
    StripedShaders() {
        write("striped.frag",
              "#include \"two_stages.glsl\"\n"
              "uniform float blue;\n"
              "layout(location = 0) out vec4 drawn;\n"
              "void main() {\n"
              "  int x = int(gl_FragCoord.x);\n"
              "  drawn = vec4(FIRST == 1 ? 1.0 : 0.0, FIRST == 1 ? 0.0 : 1.0, blue, 1.0);\n"
              "  leave_to_second(x % 3 == 1);\n"
              "}");
    }
};

class TwoStagePassTest : public testing::Test {
  protected:
    /// Of 37 x 29 pixels.
    cv::Mat4b drawn() {
        const Texture colour(TextureFormat::rgba8, 37, 29), depth(TextureFormat::depth24, 37, 29);
        const Framebuffer target({&colour}, &depth);
        TwoStagePass pass(library_, "striped.frag");
        for (int i = 0; i < 3; ++i)
            pass.draw(target, [](Program& program) { program.set("blue", 1.0f); });
        return colour.download();
    }
    static void expect_stripes(const cv::Mat4b& picture) {
        for (int y = 0; y < picture.rows; ++y)
            for (int x = 0; x < picture.cols; ++x)
                ASSERT_EQ(picture(y, x),
                          x % 3 == 1 ? cv::Vec4b(0, 255, 255, 255) : cv::Vec4b(255, 0, 255, 255))
                    << x << ", " << y;
    }

    EglContext context_;
    StripedShaders folder_;
    ShaderLibrary library_{folder_.path()};
};

TEST_F(TwoStagePassTest, TheSecondStageDrawsOnlyThePixelsLeftByTheFirst) {
    expect_stripes(drawn());
}

TEST_F(TwoStagePassTest, DrawsTheSameInBands) {
    const SlicedDrawing slices(1ns);
    expect_stripes(drawn());
}

}  // namespace
}  // namespace vantage
