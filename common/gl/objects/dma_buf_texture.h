#pragma once

#include <cstdint>
#include <string>

#include "common/gl/context/egl_context.h"
#include "common/gl/objects/texture.h"

namespace vantage {

/// One plane of a frame in memory that another driver (a camera's) shares as a dma-buf.
struct DmaBufPlane {
    int fd = -1;
    TextureFormat format = TextureFormat::r8;  ///< r8, rg8 or rgba8
    int width_px = 0, height_px = 0;
    std::uint32_t offset = 0;          ///< of the plane's first byte in the buffer
    std::uint32_t bytes_per_line = 0;  ///< padding included
};

/// A texture backed by a dma-buf plane without a copy: the next draw reads what the other driver
/// wrote. For texelFetch only (nearest, clamped). Needs EGL_EXT_image_dma_buf_import and
/// GL_OES_EGL_image.
class DmaBufTexture {
  public:
    /// The names of required extensions that the context lacks; empty if none.
    static std::string missing_extensions(const EglContext& context);

    /// Keeps the buffer alive; the descriptor may be closed afterwards. Throws Error with the
    /// driver's reason if it cannot import the plane. `context` must outlive the texture.
    DmaBufTexture(const EglContext& context, const DmaBufPlane& plane);
    ~DmaBufTexture();
    DmaBufTexture(DmaBufTexture&& other) noexcept;
    DmaBufTexture& operator=(DmaBufTexture&&) = delete;

    void bind(int unit) const;

  private:
    EGLDisplay display_ = EGL_NO_DISPLAY;
    void* image_ = nullptr;  ///< EGLImage
    GlHandle<delete_texture> texture_;
};

}  // namespace vantage
