#pragma once

#include <initializer_list>

#include <GLES3/gl31.h>
#include <opencv2/core.hpp>

#include "common/gl/gl_handle.h"
#include "common/gl/texture.h"

namespace vantage {

inline void delete_framebuffer(GLuint name) { glDeleteFramebuffers(1, &name); }

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

    /// Reads one colour target back into `image` (of the texture's size and cv_type; rows top-down
    /// as drawn). The previous framebuffer binding is restored. Waits for the GPU.
    void read(int target, cv::Mat& image) const;

    cv::Size size() const { return size_; }
    GLuint name() const { return handle_.name(); }

  private:
    GlHandle<delete_framebuffer> handle_;
    cv::Size size_;
    TextureFormat formats_[4] = {};
    int colour_targets_ = 0;
};

}  // namespace vantage
