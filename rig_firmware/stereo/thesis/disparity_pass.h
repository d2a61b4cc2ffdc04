#pragma once

#include "common/gl/fullscreen_pass.h"
#include "common/gl/objects/framebuffer.h"
#include "common/gl/objects/texture.h"
#include "rig_firmware/stereo/thesis/storage_pass.h"

namespace vantage::thesis {

/// Turns the winners into the picture that every matcher delivers. A winner that points beyond the
/// right picture's edge has no match: it is filled from the next match to its right (on that side
/// of the picture only background can lie hidden), or left unknown.
class DisparityPass {
  public:
    DisparityPass(const ShaderLibrary& library, cv::Size size, bool fill);
    /// keys: of WinnerPass. The result is valid until the next run.
    const Texture& run(const Buffer& keys);
    PassCost cost() const;
    std::size_t gpu_bytes() const { return disparity_.bytes(); }

  private:
    FullscreenPass pass_;
    Texture disparity_;
    Framebuffer target_;
};

}  // namespace vantage::thesis
