#include "common/gl/framebuffer.h"

#include "common/base/error.h"
#include "common/gl/limits.h"

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

void Framebuffer::read(int target, cv::Mat& image) const {
    CV_Assert(target >= 0 && target < colour_targets_);
    const TextureFormatInfo info = format_info(formats_[target]);
    CV_Assert(image.type() == info.cv_type && image.size() == size_);
    GLint previous = 0;
    glGetIntegerv(GL_READ_FRAMEBUFFER_BINDING, &previous);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, handle_.name());
    glReadBuffer(GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(target));
    glPixelStorei(GL_PACK_ALIGNMENT, 1);

    GLint native_format = 0, native_type = 0;
    glGetIntegerv(GL_IMPLEMENTATION_COLOR_READ_FORMAT, &native_format);
    glGetIntegerv(GL_IMPLEMENTATION_COLOR_READ_TYPE, &native_type);
    if (static_cast<GLenum>(native_format) == info.format &&
        static_cast<GLenum>(native_type) == info.type) {
        cv::Mat packed = image.isContinuous() ? image : cv::Mat(size_, info.cv_type);
        glReadPixels(0, 0, size_.width, size_.height, info.format, info.type, packed.data);
        if (packed.data != image.data) packed.copyTo(image);
    } else {
        // ES promises only four-channel reads: RGBA8, RGBA_INTEGER 32-bit, RGBA float. Read wide,
        // keep our channels.
        const int depth = CV_MAT_DEPTH(info.cv_type);
        const bool is_float = depth == CV_32F || depth == CV_16F;
        const bool is_integer = info.format == GL_RED_INTEGER || info.format == GL_RG_INTEGER ||
                                info.format == GL_RGBA_INTEGER;
        const GLenum wide_format = is_integer ? GL_RGBA_INTEGER : GL_RGBA;
        const GLenum wide_type = is_float     ? GL_FLOAT
                                 : is_integer ? GL_UNSIGNED_INT
                                              : GL_UNSIGNED_BYTE;
        cv::Mat wide(size_, is_float ? CV_32FC4 : is_integer ? CV_32SC4 : CV_8UC4);
        glReadPixels(0, 0, size_.width, size_.height, wide_format, wide_type, wide.data);
        const int channels = CV_MAT_CN(info.cv_type);
        cv::Mat narrow(size_, CV_MAKETYPE(wide.depth(), channels));
        const int pairs[] = {0, 0, 1, 1, 2, 2, 3, 3};
        cv::mixChannels(&wide, 1, &narrow, 1, pairs, static_cast<std::size_t>(channels));
        narrow.convertTo(image, depth);
    }
    glBindFramebuffer(GL_READ_FRAMEBUFFER, static_cast<GLuint>(previous));
    check_gl("reading a picture back");
}

}  // namespace vantage
