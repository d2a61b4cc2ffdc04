#include "common/virtual_stage/stage_targets.h"

#include "common/base/error.h"
#include "common/gl/limits.h"

namespace vantage {
namespace {

constexpr int samples_per_pixel = 4;

GLuint make_renderbuffer(GLenum format, cv::Size size) {
    GLuint name = 0;
    glGenRenderbuffers(1, &name);
    glBindRenderbuffer(GL_RENDERBUFFER, name);
    glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples_per_pixel, format, size.width,
                                     size.height);
    return name;
}

}  // namespace

StageTargets::StageTargets(cv::Size size)
    : size_(size),
      resolved_(TextureFormat::rgba8, size.width, size.height),
      depth_bits_(TextureFormat::r32ui, size.width, size.height),
      depth_order_(TextureFormat::depth24, size.width, size.height),
      resolved_target_({&resolved_}),
      depth_target_({&depth_bits_}, &depth_order_) {
    colour_samples_ = GlHandle<delete_renderbuffer>(make_renderbuffer(GL_RGBA8, size));
    depth_samples_ = GlHandle<delete_renderbuffer>(make_renderbuffer(GL_DEPTH_COMPONENT24, size));
    GLuint name = 0;
    glGenFramebuffers(1, &name);
    sampled_ = GlHandle<delete_framebuffer>(name);
    GLint previous = 0;
    glGetIntegerv(GL_FRAMEBUFFER_BINDING, &previous);
    glBindFramebuffer(GL_FRAMEBUFFER, name);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER,
                              colour_samples_.name());
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER,
                              depth_samples_.name());
    const GLenum status = glCheckFramebufferStatus(GL_FRAMEBUFFER);
    glBindFramebuffer(GL_FRAMEBUFFER, static_cast<GLuint>(previous));
    if (status != GL_FRAMEBUFFER_COMPLETE)
        fail("this GPU driver cannot draw the virtual stage with {} samples a pixel at {}x{}",
             samples_per_pixel, size.width, size.height);
    check_gl("allocating the virtual stage's pictures");
}

void StageTargets::bind_colour() const {
    glBindFramebuffer(GL_FRAMEBUFFER, sampled_.name());
    glViewport(0, 0, size_.width, size_.height);
}

void StageTargets::read_colour(cv::Mat& image) const {
    resolved_target_.bind();
    glBindFramebuffer(GL_READ_FRAMEBUFFER, sampled_.name());
    glBlitFramebuffer(0, 0, size_.width, size_.height, 0, 0, size_.width, size_.height,
                      GL_COLOR_BUFFER_BIT, GL_NEAREST);
    resolved_target_.read(0, image);
}

}  // namespace vantage
