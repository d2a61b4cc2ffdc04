#include "common/gl/objects/readback.h"

#include <gtest/gtest.h>

#include "common/gl/context/egl_context.h"

namespace vantage {
namespace {

class ReadbackTest : public testing::Test {
  protected:
    /// A picture of odd size with other values everywhere.
    template <class Image>
    static Image picture(int width_px, int height_px) {
        Image image(height_px, width_px);
        cv::randu(image, 0, 250);
        return image;
    }
    template <class Image>
    void expect_as_downloaded(TextureFormat format, cv::Size size) {
        const auto image = picture<Image>(size.width, size.height);
        Texture texture(format, size.width, size.height);
        texture.upload(image);
        EXPECT_FALSE(readback_.is_begun());
        readback_.begin(texture);
        EXPECT_TRUE(readback_.is_begun());
        const cv::Mat taken = readback_.take();
        EXPECT_FALSE(readback_.is_begun());
        ASSERT_EQ(taken.type(), image.type());
        ASSERT_EQ(taken.size(), image.size());
        EXPECT_EQ(cv::norm(taken, image, cv::NORM_INF), 0);
        EXPECT_EQ(cv::norm(taken, texture.download(), cv::NORM_INF), 0);
    }

    EglContext context_;
    Readback readback_;
};

TEST_F(ReadbackTest, EqualsADownload) {
    expect_as_downloaded<cv::Mat4b>(TextureFormat::rgba8, {37, 23});
    expect_as_downloaded<cv::Mat1w>(TextureFormat::r16ui, {61, 7});
    expect_as_downloaded<cv::Mat1f>(TextureFormat::r32f, {5, 19});
    expect_as_downloaded<cv::Mat1b>(TextureFormat::r8, {13, 3});
}

TEST_F(ReadbackTest, ShowsTheTextureAsItWasWhenItBegan) {
    Texture texture(TextureFormat::rgba8, 64, 48);
    texture.upload(cv::Mat4b(48, 64, cv::Vec4b(1, 2, 3, 4)));
    readback_.begin(texture);
    texture.upload(cv::Mat4b(48, 64, cv::Vec4b(9, 9, 9, 9)));
    const cv::Mat4b taken = readback_.take();
    EXPECT_EQ(taken(47, 63), cv::Vec4b(1, 2, 3, 4));
}

TEST_F(ReadbackTest, TwoCanBeInProgress) {
    Readback other;
    Texture texture(TextureFormat::rgba8, 16, 16);
    texture.upload(cv::Mat4b(16, 16, cv::Vec4b(1, 1, 1, 1)));
    readback_.begin(texture);
    texture.upload(cv::Mat4b(16, 16, cv::Vec4b(2, 2, 2, 2)));
    other.begin(texture);
    EXPECT_EQ(cv::Mat4b(other.take())(3, 3), cv::Vec4b(2, 2, 2, 2));
    EXPECT_EQ(cv::Mat4b(readback_.take())(3, 3), cv::Vec4b(1, 1, 1, 1));
}

TEST_F(ReadbackTest, LeavesTheFramebuffersBindingAlone) {
    const Texture drawn(TextureFormat::rgba8, 8, 8), read(TextureFormat::rgba8, 8, 8);
    const Framebuffer framebuffer({&drawn});
    framebuffer.bind();
    readback_.begin(read);
    (void)readback_.take();
    GLint bound = 0;
    glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &bound);
    EXPECT_EQ(static_cast<GLuint>(bound), framebuffer.name());
}

}  // namespace
}  // namespace vantage
