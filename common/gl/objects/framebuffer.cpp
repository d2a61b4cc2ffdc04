#include "common/gl/objects/framebuffer.h"

#include "common/base/error.h"
#include "common/gl/context/limits.h"

namespace vantage {

Framebuffer::Framebuffer(std::initializer_list<const Texture*> colour_targets,
                         const Texture* depth_target) {
    if (colour_targets.size() > PiLimits::max_colour_targets)
        fail("{} colour targets asked for; a Raspberry Pi 4 has {}", colour_targets.size(),
             PiLimits::max_colour_targets);
    GLint previous = 0;
    glGetIntegerv(GL_FRAMEBUFFER_BINDING, &previous);
    GLuint name = 0;
    glGenFramebuffers(1, &name);
    handle_ = GlHandle<delete_framebuffer>(name);
    glBindFramebuffer(GL_FRAMEBUFFER, name);
    GLenum buffers[PiLimits::max_colour_targets] = {};
    for (const Texture* target : colour_targets) {
        const auto attachment = GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(colour_targets_);
        glFramebufferTexture2D(GL_FRAMEBUFFER, attachment, GL_TEXTURE_2D, target->name(), 0);
        buffers[colour_targets_] = attachment;
        formats_[colour_targets_] = target->format();
        size_ = target->size();
        ++colour_targets_;
    }
    if (depth_target) {
        glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D,
                               depth_target->name(), 0);
        size_ = depth_target->size();
    }
    glDrawBuffers(colour_targets_, buffers);
    const GLenum status = glCheckFramebufferStatus(GL_FRAMEBUFFER);
    glBindFramebuffer(GL_FRAMEBUFFER, static_cast<GLuint>(previous));
    if (status != GL_FRAMEBUFFER_COMPLETE)
        fail("this GPU driver cannot render to the wanted pixel format (framebuffer status 0x{:x})",
             status);
}

void Framebuffer::bind() const {
    glBindFramebuffer(GL_FRAMEBUFFER, handle_.name());
    glViewport(0, 0, size_.width, size_.height);
}

void Framebuffer::discard_colours() const {
    bind();
    GLenum attachments[PiLimits::max_colour_targets] = {};
    for (int i = 0; i < colour_targets_; ++i)
        attachments[i] = GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(i);
    glInvalidateFramebuffer(GL_FRAMEBUFFER, colour_targets_, attachments);
}

namespace {

/// The layout in which the driver reads the framebuffer that is bound for reading.
PixelLayout readable_layout(TextureFormat format) {
    const TextureFormatInfo info = format_info(format);
    GLint native_format = 0, native_type = 0;
    glGetIntegerv(GL_IMPLEMENTATION_COLOR_READ_FORMAT, &native_format);
    glGetIntegerv(GL_IMPLEMENTATION_COLOR_READ_TYPE, &native_type);
    if (static_cast<GLenum>(native_format) == info.format &&
        static_cast<GLenum>(native_type) == info.type)
        return {info.format, info.type, info.cv_type};
    // OpenGL ES guarantees only four-channel reads: RGBA8, RGBA_INTEGER 32-bit, RGBA float.
    const int depth = CV_MAT_DEPTH(info.cv_type);
    if (depth == CV_32F || depth == CV_16F) return {GL_RGBA, GL_FLOAT, CV_32FC4};
    if (info.format == GL_RED_INTEGER || info.format == GL_RG_INTEGER ||
        info.format == GL_RGBA_INTEGER)
        return {GL_RGBA_INTEGER, GL_UNSIGNED_INT, CV_32SC4};
    return {GL_RGBA, GL_UNSIGNED_BYTE, CV_8UC4};
}

}  // namespace

cv::Mat in_format(const cv::Mat& pixels, TextureFormat format) {
    const int type = format_info(format).cv_type;
    if (pixels.type() == type) return pixels;
    const int channels = CV_MAT_CN(type);
    cv::Mat narrow(pixels.size(), CV_MAKETYPE(pixels.depth(), channels));
    const int pairs[] = {0, 0, 1, 1, 2, 2, 3, 3};
    cv::mixChannels(&pixels, 1, &narrow, 1, pairs, static_cast<std::size_t>(channels));
    cv::Mat image;
    narrow.convertTo(image, CV_MAT_DEPTH(type));
    return image;
}

void Framebuffer::read_with(int target, const std::function<void(const PixelLayout&)>& read) const {
    CV_Assert(target >= 0 && target < colour_targets_);
    GLint previous = 0;
    glGetIntegerv(GL_READ_FRAMEBUFFER_BINDING, &previous);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, handle_.name());
    glReadBuffer(GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(target));
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    read(readable_layout(formats_[target]));
    glBindFramebuffer(GL_READ_FRAMEBUFFER, static_cast<GLuint>(previous));
    check_gl("reading a picture back");
}

void Framebuffer::read(int target, cv::Mat& image) const {
    CV_Assert(target >= 0 && target < colour_targets_ && image.size() == size_ &&
              image.type() == format_info(formats_[target]).cv_type);
    read_with(target, [&](const PixelLayout& layout) {
        const bool directly = image.isContinuous() && image.type() == layout.cv_type;
        cv::Mat pixels = directly ? image : cv::Mat(size_, layout.cv_type);
        glReadPixels(0, 0, size_.width, size_.height, layout.format, layout.type, pixels.data);
        if (!directly) in_format(pixels, formats_[target]).copyTo(image);
    });
}

}  // namespace vantage
