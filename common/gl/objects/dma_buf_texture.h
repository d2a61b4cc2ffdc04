#pragma once

#include <cstdint>
#include <string>

#include "common/gl/context/egl_context.h"
#include "common/gl/objects/texture.h"

namespace vantage {

/// One plane of a picture in memory that another driver (a camera's) shares as a dma-buf.
struct DmaBufPlane {
    int fd = -1;
    TextureFormat format = TextureFormat::r8;  ///< r8, rg8 or rgba8
    int width_px = 0, height_px = 0;
    std::uint32_t offset = 0;          ///< of its first byte in the buffer
    std::uint32_t bytes_per_line = 0;  ///< padding included
};

/// A texture that is the plane itself: nothing is copied, and what the other driver writes into the
/// buffer is what the next drawing reads. For texelFetch only (nearest, clamped). By
/// EGL_EXT_image_dma_buf_import and GL_OES_EGL_image.
class DmaBufTexture {
  public:
    /// The extensions that this takes and the context lacks, by name; empty: none.
    static std::string missing_extensions(const EglContext& context);

    /// The buffer stays alive with the texture, its descriptor need not. Throws Error with the
    /// driver's reason where it does not import such a plane. `context` must outlive it.
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
