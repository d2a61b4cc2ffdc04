#include "common/gl/objects/texture.h"

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "common/base/error.h"
#include "common/gl/context/egl_context.h"
#include "common/gl/context/limits.h"
#include "common/gl/objects/framebuffer.h"

namespace vantage {
namespace {

class TextureTest : public testing::TestWithParam<TextureFormat> {
  protected:
    EglContext context_;
};

TEST_P(TextureTest, RoundTripsAnImageOfOddSize) {
    const TextureFormatInfo info = format_info(GetParam());
    cv::Mat image(13, 31, info.cv_type);
    cv::RNG random(7);
    if (image.depth() == CV_32F)
        random.fill(image, cv::RNG::UNIFORM, -10.0, 10.0);
    else
        random.fill(image, cv::RNG::UNIFORM, 0, 200);
    Texture texture(GetParam(), image.cols, image.rows);
    texture.upload(image);
    EXPECT_EQ(cv::norm(texture.download(), image, cv::NORM_INF), 0);
}

TEST_P(TextureTest, AcceptsPaddedRows) {
    const TextureFormatInfo info = format_info(GetParam());
    cv::Mat wide(9, 40, info.cv_type, cv::Scalar::all(1));
    const cv::Mat part = wide(cv::Rect(3, 2, 17, 5));
    wide.row(4).setTo(cv::Scalar::all(9));
    Texture texture(GetParam(), part.cols, part.rows);
    texture.upload(part);
    EXPECT_EQ(cv::norm(texture.download(), part, cv::NORM_INF), 0);
}

INSTANTIATE_TEST_SUITE_P(Formats, TextureTest,
                         testing::Values(TextureFormat::r8, TextureFormat::rgba8,
                                         TextureFormat::r8ui, TextureFormat::r16ui,
                                         TextureFormat::r32ui, TextureFormat::rgba32ui,
                                         TextureFormat::r32f, TextureFormat::rgba32f));

TEST(TextureOfWindows, IsDrawnToAndDownloadedAsOthers) {
    const EglContext context;
    if (!has_gl_extension("GL_EXT_texture_format_BGRA8888"))
        GTEST_SKIP() << "SKIPPED: this driver has no EXT_texture_format_BGRA8888";
    const Texture texture(TextureFormat::bgra8, 4, 3);
    const Framebuffer target({&texture});
    target.bind();
    glClearColor(1, 0.2f, 0, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    const cv::Mat4b expected(3, 4, cv::Vec4b(255, 51, 0, 255));
    EXPECT_EQ(cv::norm(texture.download(), expected, cv::NORM_INF), 0);
}

TEST(TextureLimits, RefusesSizesBeyondPiLimits) {
    const EglContext context;
    EXPECT_THROW(Texture(TextureFormat::rgba8, 5000, 10), Error);
    EXPECT_THROW(Texture(TextureFormat::rgba8, 0, 10), Error);
}

}  // namespace
}  // namespace vantage
