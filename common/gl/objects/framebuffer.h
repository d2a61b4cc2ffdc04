#pragma once

#include <functional>
#include <initializer_list>

#include <GLES3/gl31.h>
#include <opencv2/core.hpp>

#include "common/gl/objects/gl_handle.h"
#include "common/gl/objects/texture.h"

namespace vantage {

inline void delete_framebuffer(GLuint name) { glDeleteFramebuffers(1, &name); }

/// The layout of pixels that a driver reads back; may have more or wider channels than the texture.
struct PixelLayout {
    GLenum format = 0, type = 0;
    int cv_type = 0;
};
/// Converts pixels to the format's own cv_type; shares the data if they already have it.
cv::Mat in_format(const cv::Mat& pixels, TextureFormat format);

/// Draws into one to four textures of one size, with an optional depth texture. The textures must
/// outlive it.
class Framebuffer {
  public:
    /// Throws Error for more than four colour targets or a combination that the driver cannot draw.
    explicit Framebuffer(std::initializer_list<const Texture*> colour_targets,
                         const Texture* depth_target = nullptr);

    /// Binds it for drawing and sets the viewport to its full size.
    void bind() const;

    /// Binds it for drawing and tells the driver that its colour targets need not be kept; the next
    /// draw must cover every pixel.
    void discard_colours() const;

    /// Reads one colour target into `image` (of the texture's size and cv_type, top row first).
    /// Restores the framebuffer binding. Waits for the GPU.
    void read(int target, cv::Mat& image) const;

    /// Calls `read` with the target bound for reading and the layout that glReadPixels returns, for
    /// callers that read on their own.
    void read_with(int target, const std::function<void(const PixelLayout&)>& read) const;

    cv::Size size() const { return size_; }
    GLuint name() const { return handle_.name(); }

  private:
    GlHandle<delete_framebuffer> handle_;
    cv::Size size_;
    TextureFormat formats_[4] = {};
    int colour_targets_ = 0;
};

}  // namespace vantage
