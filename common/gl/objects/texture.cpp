#include "common/gl/objects/texture.h"

#include <algorithm>
#include <bit>

#include <GLES2/gl2ext.h>

#include "common/base/error.h"
#include "common/gl/context/limits.h"
#include "common/gl/objects/framebuffer.h"

namespace vantage {

TextureFormatInfo format_info(TextureFormat format) {
    switch (format) {
        case TextureFormat::r8:
            return {GL_R8, GL_RED, GL_UNSIGNED_BYTE, 1, CV_8UC1};
        case TextureFormat::rg8:
            return {GL_RG8, GL_RG, GL_UNSIGNED_BYTE, 2, CV_8UC2};
        case TextureFormat::rgba8:
            return {GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE, 4, CV_8UC4};
        case TextureFormat::bgra8:
            return {GL_BGRA_EXT, GL_RGBA, GL_UNSIGNED_BYTE, 4, CV_8UC4};
        case TextureFormat::r8ui:
            return {GL_R8UI, GL_RED_INTEGER, GL_UNSIGNED_BYTE, 1, CV_8UC1};
        case TextureFormat::r16ui:
            return {GL_R16UI, GL_RED_INTEGER, GL_UNSIGNED_SHORT, 2, CV_16UC1};
        case TextureFormat::r32ui:
            return {GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, 4, CV_32SC1};
        case TextureFormat::rg32ui:
            return {GL_RG32UI, GL_RG_INTEGER, GL_UNSIGNED_INT, 8, CV_32SC2};
        case TextureFormat::rgba8ui:
            return {GL_RGBA8UI, GL_RGBA_INTEGER, GL_UNSIGNED_BYTE, 4, CV_8UC4};
        case TextureFormat::rgba16ui:
            return {GL_RGBA16UI, GL_RGBA_INTEGER, GL_UNSIGNED_SHORT, 8, CV_16UC4};
        case TextureFormat::rgba32ui:
            return {GL_RGBA32UI, GL_RGBA_INTEGER, GL_UNSIGNED_INT, 16, CV_32SC4};
        case TextureFormat::r16f:
            return {GL_R16F, GL_RED, GL_HALF_FLOAT, 2, CV_16FC1};
        case TextureFormat::rgba16f:
            return {GL_RGBA16F, GL_RGBA, GL_HALF_FLOAT, 8, CV_16FC4};
        case TextureFormat::r32f:
            return {GL_R32F, GL_RED, GL_FLOAT, 4, CV_32FC1};
        case TextureFormat::rg32f:
            return {GL_RG32F, GL_RG, GL_FLOAT, 8, CV_32FC2};
        case TextureFormat::rgba32f:
            return {GL_RGBA32F, GL_RGBA, GL_FLOAT, 16, CV_32FC4};
        case TextureFormat::depth24:
            return {GL_DEPTH_COMPONENT24, GL_DEPTH_COMPONENT, GL_UNSIGNED_INT, 4, -1};
        case TextureFormat::depth32f:
            return {GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT, GL_FLOAT, 4, -1};
    }
    fail("unknown texture format {}", static_cast<int>(format));
}

Texture::Texture(TextureFormat format, int width_px, int height_px, Filter filter, bool mipmapped)
    : format_(format), width_px_(width_px), height_px_(height_px) {
    if (width_px < 1 || height_px < 1 || width_px > PiLimits::max_image_side_px ||
        height_px > PiLimits::max_image_side_px)
        fail("a GPU picture of {}x{} is not possible: each side must be 1 to {} pixels", width_px,
             height_px, PiLimits::max_image_side_px);
    if (mipmapped) levels_ = std::bit_width(static_cast<unsigned>(std::max(width_px, height_px)));
    GLuint name = 0;
    glGenTextures(1, &name);
    handle_ = GlHandle<delete_texture>(name);
    glBindTexture(GL_TEXTURE_2D, name);
    if (format == TextureFormat::bgra8)
        // EXT_texture_format_BGRA8888 has no sized format, which glTexStorage2D needs.
        glTexImage2D(GL_TEXTURE_2D, 0, GL_BGRA_EXT, width_px, height_px, 0, GL_BGRA_EXT,
                     GL_UNSIGNED_BYTE, nullptr);
    else
        glTexStorage2D(GL_TEXTURE_2D, levels_, format_info(format).internal_format, width_px,
                       height_px);
    const GLint magnify = filter == Filter::linear ? GL_LINEAR : GL_NEAREST;
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, magnify);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER,
                    mipmapped ? GL_LINEAR_MIPMAP_LINEAR : magnify);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    check_gl("allocating a texture");
}

void Texture::upload(const cv::Mat& image) {
    const TextureFormatInfo info = format_info(format_);
    CV_Assert(format_ != TextureFormat::bgra8 && image.type() == info.cv_type &&
              image.cols == width_px_ && image.rows == height_px_);
    glBindTexture(GL_TEXTURE_2D, handle_.name());
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    const bool padded = !image.isContinuous();
    // GL's row length counts pixels; a stride that is not a multiple of a pixel needs a copy.
    cv::Mat source = image;
    if (padded && image.step[0] % static_cast<std::size_t>(info.bytes_per_pixel) != 0)
        source = image.clone();
    glPixelStorei(
        GL_UNPACK_ROW_LENGTH,
        static_cast<GLint>(source.step[0] / static_cast<std::size_t>(info.bytes_per_pixel)));
    glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, width_px_, height_px_, info.format, info.type,
                    source.data);
    glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
}

void Texture::generate_mipmaps() {
    glBindTexture(GL_TEXTURE_2D, handle_.name());
    glGenerateMipmap(GL_TEXTURE_2D);
}

cv::Mat Texture::download() const {
    const TextureFormatInfo info = format_info(format_);
    CV_Assert(info.cv_type >= 0);
    cv::Mat image(height_px_, width_px_, info.cv_type);
    const Framebuffer framebuffer({this});
    framebuffer.read(0, image);
    return image;
}

void Texture::bind(int unit) const {
    glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
    glBindTexture(GL_TEXTURE_2D, handle_.name());
}

std::size_t Texture::bytes() const {
    const auto pixels = static_cast<std::size_t>(width_px_) * static_cast<std::size_t>(height_px_);
    const std::size_t base =
        pixels * static_cast<std::size_t>(format_info(format_).bytes_per_pixel);
    return levels_ > 1 ? base + base / 3 : base;
}

}  // namespace vantage
