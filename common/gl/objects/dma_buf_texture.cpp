#include "common/gl/objects/dma_buf_texture.h"

#include <cerrno>
#include <utility>
#include <vector>

#include <EGL/eglext.h>
#include <GLES2/gl2ext.h>
#include <gbm.h>
#include <linux/dma-buf.h>
#include <sys/ioctl.h>

#include "common/base/error.h"
#include "common/gl/context/limits.h"

namespace vantage {
namespace {

constexpr const char* modifiers_extension = "EGL_EXT_image_dma_buf_import_modifiers";

/// The DRM format code for a texel format.
std::uint32_t kernel_format(TextureFormat format) {
    switch (format) {
        case TextureFormat::r8:
            return GBM_FORMAT_R8;
        case TextureFormat::rg8:
            return GBM_FORMAT_GR88;
        case TextureFormat::rgba8:
            return GBM_FORMAT_ABGR8888;
        default:
            fail("a camera's buffer holds no texels of format {}", static_cast<int>(format));
    }
}

/// Whether a descriptor is a dma-buf. Some drivers (llvmpipe of Mesa 25) import any descriptor and
/// crash later.
bool is_dma_buf(int fd) {
    dma_buf_sync access{.flags = DMA_BUF_SYNC_START | DMA_BUF_SYNC_READ};
    // Only the kind of error matters: a dma-buf's own driver may refuse with another one.
    if (::ioctl(fd, DMA_BUF_IOCTL_SYNC, &access) != 0)
        return errno != ENOTTY && errno != EBADF && errno != EINVAL;
    access.flags = DMA_BUF_SYNC_END | DMA_BUF_SYNC_READ;
    ::ioctl(fd, DMA_BUF_IOCTL_SYNC, &access);
    return true;
}

template <class Function>
Function find(const char* name) {
    return reinterpret_cast<Function>(eglGetProcAddress(name));
}

}  // namespace

std::string DmaBufTexture::missing_extensions(const EglContext& context) {
    std::string missing;
    const auto need = [&](const char* extension, bool is_there) {
        if (!is_there) missing += (missing.empty() ? "" : ", ") + std::string(extension);
    };
    for (const char* extension : {"EGL_KHR_image_base", "EGL_EXT_image_dma_buf_import"})
        need(extension, context.has_extension(extension));
    need("GL_OES_EGL_image", has_gl_extension("GL_OES_EGL_image"));
    return missing;
}

DmaBufTexture::DmaBufTexture(const EglContext& context, const DmaBufPlane& plane)
    : display_(context.display()) {
    if (const std::string missing = missing_extensions(context); !missing.empty())
        fail("the driver cannot import camera buffers: it lacks {}", missing);
    if (!is_dma_buf(plane.fd))
        fail("a camera's buffer cannot be imported: descriptor {} is no dma-buf", plane.fd);
    std::vector<EGLint> attributes = {EGL_WIDTH,
                                      plane.width_px,
                                      EGL_HEIGHT,
                                      plane.height_px,
                                      EGL_LINUX_DRM_FOURCC_EXT,
                                      static_cast<EGLint>(kernel_format(plane.format)),
                                      EGL_DMA_BUF_PLANE0_FD_EXT,
                                      plane.fd,
                                      EGL_DMA_BUF_PLANE0_OFFSET_EXT,
                                      static_cast<EGLint>(plane.offset),
                                      EGL_DMA_BUF_PLANE0_PITCH_EXT,
                                      static_cast<EGLint>(plane.bytes_per_line)};
    // Without a modifier some drivers assume a tiled layout; 0 means linear rows.
    if (context.has_extension(modifiers_extension))
        attributes.insert(attributes.end(), {EGL_DMA_BUF_PLANE0_MODIFIER_LO_EXT, 0,
                                             EGL_DMA_BUF_PLANE0_MODIFIER_HI_EXT, 0});
    attributes.push_back(EGL_NONE);
    const auto create = find<PFNEGLCREATEIMAGEKHRPROC>("eglCreateImageKHR");
    const auto attach = find<PFNGLEGLIMAGETARGETTEXTURE2DOESPROC>("glEGLImageTargetTexture2DOES");
    if (!create || !attach) fail("the driver names the import of buffers and does not have it");
    image_ = create(display_, EGL_NO_CONTEXT, EGL_LINUX_DMA_BUF_EXT, nullptr, attributes.data());
    if (image_ == EGL_NO_IMAGE_KHR)
        fail("the driver does not import a camera's plane of {}x{} in lines of {} bytes: {}",
             plane.width_px, plane.height_px, plane.bytes_per_line, egl_error_name());
    GLuint name = 0;
    glGenTextures(1, &name);
    texture_ = GlHandle<delete_texture>(name);
    glBindTexture(GL_TEXTURE_2D, name);
    attach(GL_TEXTURE_2D, image_);
    for (const GLenum filter : {GL_TEXTURE_MAG_FILTER, GL_TEXTURE_MIN_FILTER})
        glTexParameteri(GL_TEXTURE_2D, filter, GL_NEAREST);
    for (const GLenum wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T})
        glTexParameteri(GL_TEXTURE_2D, wrap, GL_CLAMP_TO_EDGE);
    try {
        check_gl("making a camera's buffer a texture");
    } catch (...) {
        find<PFNEGLDESTROYIMAGEKHRPROC>("eglDestroyImageKHR")(display_, image_);
        throw;
    }
}

DmaBufTexture::~DmaBufTexture() {
    if (image_) find<PFNEGLDESTROYIMAGEKHRPROC>("eglDestroyImageKHR")(display_, image_);
}

DmaBufTexture::DmaBufTexture(DmaBufTexture&& other) noexcept
    : display_(other.display_),
      image_(std::exchange(other.image_, nullptr)),
      texture_(std::move(other.texture_)) {}

void DmaBufTexture::bind(int unit) const {
    glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
    glBindTexture(GL_TEXTURE_2D, texture_.name());
}

}  // namespace vantage
