#pragma once

#include <opencv2/core.hpp>

#include "common/gl/fullscreen_pass.h"
#include "common/gl/objects/framebuffer.h"
#include "common/gl/objects/texture.h"
#include "rig_firmware/stereo/pass_profiler.h"

namespace vantage {

/// Returns the size of a picture that is reduced to this width; 0: its own. The aspect ratio stays.
cv::Size reduced_size(cv::Size picture, int width_px);

/// Reduces the pictures of one camera to a smaller size, for a matcher that works on fewer pixels
/// than the colour picture has. Belongs to one context.
class ReducePass {
  public:
    /// Precondition: neither side of `to` is larger than that of `from`.
    ReducePass(const ShaderLibrary& library, cv::Size from, cv::Size to);

    /// picture: rgba8 of the size `from`, sampled bilinearly. The result is rgba8 of the size `to`,
    /// valid until the next call.
    const Texture& reduce(const Texture& picture);

    const Texture& reduced() const { return reduced_; }  ///< of the last reduce()

    /// Of one reduce().
    PassCost cost() const;
    std::size_t gpu_bytes() const;

  private:
    cv::Size from_;
    Texture reduced_;
    Framebuffer target_;
    FullscreenPass pass_;
};

}  // namespace vantage
