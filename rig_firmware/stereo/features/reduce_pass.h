#pragma once

#include <opencv2/core.hpp>

#include "common/gl/fullscreen_pass.h"
#include "common/gl/objects/framebuffer.h"
#include "common/gl/objects/texture.h"

namespace vantage {

/// Reduces the pictures of one camera to a smaller size, for a matcher that works on fewer pixels
/// than the colour picture has. Belongs to one context.
class ReducePass {
  public:
    /// Precondition: neither side of `to` is larger than that of `from`.
    ReducePass(const ShaderLibrary& library, cv::Size from, cv::Size to);

    /// picture: rgba8 of the size `from`, sampled bilinearly. The result is rgba8 of the size `to`,
    /// valid until the next call.
    const Texture& reduce(const Texture& picture);

  private:
    cv::Size from_;
    Texture reduced_;
    Framebuffer target_;
    FullscreenPass pass_;
};

}  // namespace vantage
