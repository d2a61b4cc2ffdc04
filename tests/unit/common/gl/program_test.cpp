#include "common/gl/objects/program.h"

#include <array>
#include <string>

#include <gtest/gtest.h>

#include "common/gl/context/egl_context.h"
#include "common/gl/fullscreen_pass.h"
#include "common/gl/objects/buffer.h"
#include "tests/support/thrown_sentence.h"
#include "tests/unit/common/gl/shader_folder.h"

namespace vantage {
namespace {

/// Writes a colour that the shader text gives.
std::string paints(const std::string& colour) {
    return "layout(location = 0) out vec4 colour;\nvoid main() { colour = " + colour + "; }\n";
}

class ProgramTest : public testing::Test {
  protected:
    cv::Vec4b painted_by(FullscreenPass& pass) const {
        const Texture target(TextureFormat::rgba8, 3, 3);
        const Framebuffer framebuffer({&target});
        pass.use();
        pass.draw(framebuffer);
        return cv::Mat4b(target.download())(1, 1);
    }

    EglContext context_;
    ShaderFolder folder_;
};

TEST_F(ProgramTest, NamesAShaderThatDoesNotCompileAndTheReason) {
    folder_.write("bad.frag", "void main() { undeclared = 1.0; }\n");
    const ShaderLibrary library(folder_.path());
    const std::string refusal =
        thrown_sentence([&] { Program::render(library, "fullscreen.vert", "bad.frag"); });
    EXPECT_NE(refusal.find("shader bad.frag does not compile"), std::string::npos);
    EXPECT_NE(refusal.find("undeclared"), std::string::npos) << refusal;
}

TEST_F(ProgramTest, NamesShadersThatDoNotLink) {
    folder_.write("needs.frag",
                  "in vec2 never_written;\nlayout(location = 0) out vec4 colour;\n"
                  "void main() { colour = never_written.xyxy; }\n");
    const ShaderLibrary library(folder_.path());
    EXPECT_NE(thrown_sentence([&] {
                  Program::render(library, "fullscreen.vert", "needs.frag");
              }).find("do not link"),
              std::string::npos);
}

TEST_F(ProgramTest, TakesDefines) {
    folder_.write("a.frag",
                  "#ifndef RED\n#define RED 0.0\n#endif\n" + paints("vec4(RED, 0, 0, 1)"));
    const ShaderLibrary library(folder_.path());
    FullscreenPass plain(library, "a.frag"), red(library, "a.frag", {{"RED", "1.0"}});
    EXPECT_EQ(painted_by(plain), cv::Vec4b(0, 0, 0, 255));
    EXPECT_EQ(painted_by(red), cv::Vec4b(255, 0, 0, 255));
}

TEST_F(ProgramTest, ReloadsAnEditedShaderAndKeepsTheLastGoodOneOnErrors) {
    folder_.write("a.frag", paints("vec4(1, 0, 0, 1)"));
    ShaderLibrary library(folder_.path());
    FullscreenPass pass(library, "a.frag");
    const cv::Vec4b red(255, 0, 0, 255), green(0, 255, 0, 255), blue(0, 0, 255, 255);
    EXPECT_EQ(painted_by(pass), red);

    folder_.write("a.frag", paints("vec4(0, 1, 0, 1)"));
    EXPECT_EQ(painted_by(pass), red) << "not before the library has looked";
    EXPECT_TRUE(library.poll());
    EXPECT_EQ(painted_by(pass), green);

    folder_.write("a.frag", "void main() { oops }\n");
    EXPECT_TRUE(library.poll());
    testing::internal::CaptureStderr();
    EXPECT_EQ(painted_by(pass), green);
    EXPECT_EQ(painted_by(pass), green);
    const std::string log = testing::internal::GetCapturedStderr();
    EXPECT_NE(log.find("a.frag does not compile"), std::string::npos);
    EXPECT_EQ(log.find("stays in use"), log.rfind("stays in use")) << "logged once";

    folder_.write("a.frag", paints("vec4(0, 0, 1, 1)"));
    EXPECT_TRUE(library.poll());
    EXPECT_EQ(painted_by(pass), blue) << "mended";
}

TEST_F(ProgramTest, SetsEveryKindOfUniform) {
    folder_.write("a.frag",
                  "uniform int i; uniform uint u; uniform float f; uniform ivec2 i2;\n"
                  "uniform vec2 v2; uniform vec3 v3; uniform vec4 v4; uniform mat3 m3;\n"
                  "uniform mat4 m4; uniform vec4 list[3];\n" +
                      paints("vec4(float(i == -3 && u == 7u && f == 0.5 && i2 == ivec2(1, -2)),\n"
                             "float(v2 == vec2(1, 2) && v3 == vec3(3, 4, 5) && v4 == vec4(6)),\n"
                             "float((m3 * vec3(0, 1, 0)).x == 9.0 && (m4 * vec4(0, 0, 1, 0)).x "
                             "== 8.0),\n"
                             "float(list[0].x == 1.0 && list[2].w == 12.0))"));
    const ShaderLibrary library(folder_.path());
    FullscreenPass pass(library, "a.frag");
    Program& program = pass.use();
    program.set("i", -3);
    program.set("u", 7u);
    program.set("f", 0.5f);
    program.set("i2", Eigen::Vector2i(1, -2));
    program.set("v2", Eigen::Vector2f(1, 2));
    program.set("v3", Eigen::Vector3f(3, 4, 5));
    program.set("v4", Eigen::Vector4f(6, 6, 6, 6));
    Eigen::Matrix3f m3 = Eigen::Matrix3f::Zero();
    m3(0, 1) = 9;
    program.set("m3", m3);
    Eigen::Matrix4f m4 = Eigen::Matrix4f::Zero();
    m4(0, 2) = 8;
    program.set("m4", m4);
    const std::array<Eigen::Vector4f, 3> list = {
        Eigen::Vector4f(1, 2, 3, 4), Eigen::Vector4f(5, 6, 7, 8), Eigen::Vector4f(9, 10, 11, 12)};
    program.set("list", std::span<const Eigen::Vector4f>(list));
    program.set("removed_by_the_compiler", 1.0f);
    EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
    EXPECT_EQ(painted_by(pass), cv::Vec4b(255, 255, 255, 255));
}

TEST_F(ProgramTest, BindsInputsByName) {
    folder_.write(
        "a.frag",
        "uniform highp usampler2D whole; uniform sampler2D list[3]; uniform sampler2D one;\n"
        "uniform float gains[2];\n" +
            paints("vec4(float(texelFetch(whole, ivec2(0), 0).r == 7u),\n"
                   "texelFetch(list[0], ivec2(0), 0).r + gains[1],\n"
                   "texelFetch(list[2], ivec2(0), 0).r,\n"
                   "texelFetch(one, ivec2(0), 0).r)"));
    const ShaderLibrary library(folder_.path());
    FullscreenPass pass(library, "a.frag");
    const auto grey = [](int value) {
        Texture texture(TextureFormat::r8, 1, 1);
        texture.upload(cv::Mat1b(1, 1, static_cast<uchar>(value)));
        return texture;
    };
    Texture whole(TextureFormat::r16ui, 1, 1);
    whole.upload(cv::Mat1w(1, 1, std::uint16_t{7}));
    const Texture first = grey(10), last = grey(20), one = grey(30), other = grey(40);
    // Made before the inputs are bound: a new texture is bound to the active unit.
    const Texture target(TextureFormat::rgba8, 3, 3);
    const Framebuffer framebuffer({&target});
    const auto painted = [&] {
        pass.draw(framebuffer);
        return cv::Mat4b(target.download())(1, 1);
    };
    Program& program = pass.use();
    program.input("one", one);
    program.input("list", 2, last);
    program.input("list", 0, first);
    program.input("whole", whole);
    program.input("removed_by_the_compiler", other);
    program.set("gains", 1, 1 / 255.0f);
    EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
    EXPECT_EQ(painted(), cv::Vec4b(255, 11, 20, 30));
    // download() has bound the target to the active unit.
    pass.use().input("whole", whole);
    program.input("list", 2, last);
    program.input("list", 0, first);
    program.input("one", other);
    EXPECT_EQ(painted(), cv::Vec4b(255, 11, 20, 40));
}

/// Counts, for every cell of a grid, how often it is visited; and visits beyond the grid.
std::string counting_shader(const std::string& size) {
    return "layout(local_size_x = " + size +
           ") in;\n"
           "layout(std430, binding = 0) buffer Counts { uint counts[]; };\n"
           "uniform ivec2 size;\n"
           "void main() {\n"
           "    ivec2 at = ivec2(gl_GlobalInvocationID.xy);\n"
           "    if (at.x < size.x && at.y < size.y) atomicAdd(counts[at.y * size.x + at.x], 1u);\n"
           "}\n";
}

TEST_F(ProgramTest, DispatchesOverEveryCellOfAnOddSizeOnce) {
    folder_.write("a.comp", counting_shader("8, local_size_y = 8"));
    const ShaderLibrary library(folder_.path());
    Program program = Program::compute(library, "a.comp");
    constexpr int width = 61, height = 47;
    std::vector<unsigned> counts(width * height, 0);
    const Buffer buffer = Buffer::of(std::span<const unsigned>(counts));
    buffer.bind_storage(0);
    program.use();
    program.set("size", Eigen::Vector2i(width, height));
    program.dispatch_over(width, height);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    buffer.read(0, std::as_writable_bytes(std::span(counts)));
    for (const unsigned count : counts) ASSERT_EQ(count, 1u);
}

TEST_F(ProgramTest, RefusesWorkgroupsThatAPiCannotRun) {
    folder_.write("fits.comp", counting_shader("16, local_size_y = 16"));
    folder_.write("large.comp", counting_shader("16, local_size_y = 17"));
    const ShaderLibrary library(folder_.path());
    EXPECT_NO_THROW(Program::compute(library, "fits.comp"));
    EXPECT_EQ(thrown_sentence([&] { Program::compute(library, "large.comp"); }),
              "shader large.comp has workgroups of 272 invocations; a Raspberry Pi supports 256");
}

TEST_F(ProgramTest, DrawsRowZeroOnTop) {
    folder_.write("a.frag", paints("vec4((gl_FragCoord.xy - 0.5) / 255.0, 0, 1)"));
    const ShaderLibrary library(folder_.path());
    FullscreenPass pass(library, "a.frag");
    const Texture target(TextureFormat::rgba8, 31, 23);
    const Framebuffer framebuffer({&target});
    pass.use();
    pass.draw(framebuffer);
    const cv::Mat4b picture = target.download();
    for (int y = 0; y < 23; ++y)
        for (int x = 0; x < 31; ++x) {
            ASSERT_EQ(picture(y, x)[0], x);
            ASSERT_EQ(picture(y, x)[1], y);
        }
}

}  // namespace
}  // namespace vantage
