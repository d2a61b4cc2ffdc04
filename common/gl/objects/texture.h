#pragma once

#include <cstddef>

#include <GLES3/gl31.h>
#include <opencv2/core.hpp>

#include "common/gl/objects/gl_handle.h"

namespace vantage {

inline void delete_texture(GLuint name) { glDeleteTextures(1, &name); }

/// The texel formats in use. All but bgra8 are core in OpenGL ES 3.1.
enum class TextureFormat {
    r8,
    rg8,
    rgba8,  // normalised
    bgra8,  // the format of windows; drawn to and downloaded as rgba8, never uploaded; needs
            // EXT_texture_format_BGRA8888
    r8ui,
    r16ui,
    r32ui,
    rg32ui,
    rgba8ui,
    rgba16ui,
    rgba32ui,  // integer: fetched, never filtered
    r16f,
    rgba16f,
    r32f,
    rg32f,
    rgba32f,  // float: a colour target only with EXT_color_buffer_float
    depth24,
    depth32f,
};

struct TextureFormatInfo {
    GLenum internal_format, format, type;
    int bytes_per_pixel;
    int cv_type;  ///< cv::Mat type with the same texels; -1: none
};
TextureFormatInfo format_info(TextureFormat format);

enum class Filter { nearest, linear };

/// A 2-D texture of fixed size with one level or a full mip chain, clamped at the edges.
class Texture {
  public:
    /// Throws Error if a side is not 1 to PiLimits::max_image_side_px, or if memory runs out.
    Texture(TextureFormat format, int width_px, int height_px, Filter filter = Filter::nearest,
            bool mipmapped = false);

    /// `image` is width x height of the format's cv_type; rows may be padded.
    void upload(const cv::Mat& image);
    void generate_mipmaps();
    /// Reads the texture back through a framebuffer, for tests and files. Waits for the GPU.
    cv::Mat download() const;

    void bind(int unit) const;

    GLuint name() const { return handle_.name(); }
    TextureFormat format() const { return format_; }
    int width_px() const { return width_px_; }
    int height_px() const { return height_px_; }
    cv::Size size() const { return {width_px_, height_px_}; }
    std::size_t bytes() const;

  private:
    GlHandle<delete_texture> handle_;
    TextureFormat format_;
    int width_px_, height_px_;
    int levels_ = 1;
};

}  // namespace vantage
