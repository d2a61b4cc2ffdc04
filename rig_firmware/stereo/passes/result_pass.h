#pragma once

#include "common/gl/buffer.h"
#include "common/gl/framebuffer.h"
#include "common/gl/fullscreen_pass.h"
#include "common/gl/texture.h"
#include "rig_firmware/stereo/pass_profiler.h"
#include "rig_firmware/stereo/passes/stereo_layout.h"

namespace vantage {

/// 3x3 median into the r16ui texture that a matcher gives back.
class ResultPass {
  public:
    ResultPass(const ShaderLibrary& library, const StereoLayout& layout);

    const Texture& run(PassProfiler& profiler, const Buffer& disparity);

    std::size_t gpu_bytes() const { return result_.bytes(); }

  private:
    StereoLayout layout_;
    FullscreenPass pass_;
    Texture result_;
    Framebuffer target_;
};

}  // namespace vantage
