#include "common/gl/objects/framebuffer.h"

#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/gl/context/egl_context.h"
#include "common/gl/fullscreen_pass.h"
#include "tests/unit/common/gl/shader_folder.h"

namespace vantage {
namespace {

class FramebufferTest : public testing::Test {
  protected:
    EglContext context_;
};

TEST_F(FramebufferTest, DrawsIntoFourTargetsOfDifferentFormats) {
    const ShaderFolder folder;
    folder.write("four.frag",
                 "layout(location = 0) out vec4 a;\nlayout(location = 1) out uint b;\n"
                 "layout(location = 2) out uvec4 c;\nlayout(location = 3) out float d;\n"
                 "void main() { a = vec4(0.2, 0.4, 0.6, 1.0); b = 40000u;\n"
                 "c = uvec4(1, 2, 3, 4000000000u); d = -2.5; }\n");
    const ShaderLibrary library(folder.path());
    FullscreenPass pass(library, "four.frag");
    const Texture a(TextureFormat::rgba8, 5, 4), b(TextureFormat::r16ui, 5, 4),
        c(TextureFormat::rgba32ui, 5, 4), d(TextureFormat::r32f, 5, 4);
    const Framebuffer target({&a, &b, &c, &d});
    pass.use();
    pass.draw(target);
    EXPECT_EQ(cv::Mat4b(a.download())(3, 4), cv::Vec4b(51, 102, 153, 255));
    EXPECT_EQ(cv::Mat1w(b.download())(3, 4), 40000);
    EXPECT_EQ(static_cast<unsigned>(c.download().at<cv::Vec4i>(3, 4)[3]), 4000000000u);
    EXPECT_EQ(cv::Mat1f(d.download())(3, 4), -2.5f);
    cv::Mat1w second(4, 5);
    target.read(1, second);
    EXPECT_EQ(second(0, 0), 40000) << "by its place among the targets too";
}

TEST_F(FramebufferTest, ReadsIntoPartsOfLargerPictures) {
    Texture texture(TextureFormat::rgba8, 3, 2);
    texture.upload(cv::Mat4b(2, 3, cv::Vec4b(1, 2, 3, 4)));
    cv::Mat4b large(6, 7, cv::Vec4b(9, 9, 9, 9));
    cv::Mat part = large(cv::Rect(2, 1, 3, 2));
    Framebuffer({&texture}).read(0, part);
    EXPECT_EQ(large(1, 2), cv::Vec4b(1, 2, 3, 4));
    EXPECT_EQ(large(2, 4), cv::Vec4b(1, 2, 3, 4));
    EXPECT_EQ(large(1, 5), cv::Vec4b(9, 9, 9, 9));
    EXPECT_EQ(large(3, 2), cv::Vec4b(9, 9, 9, 9));
}

TEST_F(FramebufferTest, RefusesMoreTargetsThanAPiHas) {
    std::vector<std::unique_ptr<Texture>> t;
    for (int i = 0; i < 5; ++i) t.push_back(std::make_unique<Texture>(TextureFormat::rgba8, 4, 4));
    EXPECT_NO_THROW(Framebuffer({t[0].get(), t[1].get(), t[2].get(), t[3].get()}));
    try {
        const Framebuffer five({t[0].get(), t[1].get(), t[2].get(), t[3].get(), t[4].get()});
        FAIL() << "taken";
    } catch (const Error& error) {
        EXPECT_STREQ(error.what(), "5 colour targets asked for; a Raspberry Pi 4 has 4");
    }
}

TEST_F(FramebufferTest, RefusesFormatsThatTheDriverCannotDraw) {
    const Texture depth(TextureFormat::depth24, 4, 4);
    EXPECT_THROW(Framebuffer({&depth}), Error) << "depth is no colour";
}

TEST_F(FramebufferTest, DrawsDepthAlone) {
    const Texture depth(TextureFormat::depth24, 6, 5);
    const Framebuffer target({}, &depth);
    EXPECT_EQ(target.size(), cv::Size(6, 5));
    target.bind();
    glClear(GL_DEPTH_BUFFER_BIT);
    EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
}

TEST_F(FramebufferTest, RestoresTheBoundFramebuffer) {
    const Texture texture(TextureFormat::rgba8, 4, 4);
    const Framebuffer first({&texture});
    first.bind();
    const Framebuffer second({&texture});
    cv::Mat4b image(4, 4);
    second.read(0, image);
    GLint drawing = 0, reading = 0;
    glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &drawing);
    glGetIntegerv(GL_READ_FRAMEBUFFER_BINDING, &reading);
    EXPECT_EQ(drawing, static_cast<GLint>(first.name()));
    EXPECT_EQ(reading, static_cast<GLint>(first.name()));
}

}  // namespace
}  // namespace vantage
