#pragma once

#include "common/gl/objects/buffer.h"
#include "common/gl/objects/program.h"
#include "rig_firmware/stereo/pass_profiler.h"
#include "rig_firmware/stereo/volume/stereo_layout.h"

namespace vantage {

/// 3x3 median of what is known; what is not stays so.
class MedianPass {
  public:
    MedianPass(const ShaderLibrary& library, const StereoLayout& layout);

    /// Both in LeftRightPass's form.
    void run(PassProfiler& profiler, const Buffer& disparity, const Buffer& medians);

  private:
    StereoLayout layout_;
    Program program_;
};

}  // namespace vantage
