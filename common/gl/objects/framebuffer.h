#pragma once

#include <functional>
#include <initializer_list>

#include <GLES3/gl31.h>
#include <opencv2/core.hpp>

#include "common/gl/objects/gl_handle.h"
#include "common/gl/objects/texture.h"

namespace vantage {

inline void delete_framebuffer(GLuint name) { glDeleteFramebuffers(1, &name); }

/// Pixels as a driver reads them back; their channels may be more and wider than the texture's.
struct PixelLayout {
    GLenum format = 0, type = 0;
    int cv_type = 0;
};
/// Pixels of such a layout as the format's own cv_type; shared where they are that.
cv::Mat in_format(const cv::Mat& pixels, TextureFormat format);

/// Draws into one to four textures of one size, with an optional depth texture. The textures must
/// outlive it.
class Framebuffer {
  public:
    /// Throws Error if there are more than four colour targets or the driver cannot render to this
    /// combination.
    explicit Framebuffer(std::initializer_list<const Texture*> colour_targets,
                         const Texture* depth_target = nullptr);

    /// Binds it for drawing and sets the viewport to its full size.
    void bind() const;

    /// Binds it and tells the driver that the contents of its colour targets are of no use any
    /// more, before a drawing that covers every pixel.
    void discard_colours() const;

    /// Reads one colour target back into `image` (of the texture's size and cv_type; rows top-down
    /// as drawn). The previous framebuffer binding is restored. Waits for the GPU.
    void read(int target, cv::Mat& image) const;

    /// For those that read on their own: called with the target bound for reading and with what
    /// glReadPixels gives of it.
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
