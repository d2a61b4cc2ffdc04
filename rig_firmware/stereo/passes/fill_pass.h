#pragma once

#include "common/gl/buffer.h"
#include "common/gl/program.h"
#include "rig_firmware/stereo/pass_profiler.h"
#include "rig_firmware/stereo/passes/stereo_layout.h"

namespace vantage {

/// Makes disparity dense from the background side; confidence of what it fills is 0.
class FillPass {
  public:
    FillPass(const ShaderLibrary& library, const StereoLayout& layout);

    /// Both in LeftRightPass's form. `filled` holds, before, those of the disparities that the fill
    /// may spread (SupportPass), and after, every disparity and what the unknown ones became.
    void run(PassProfiler& profiler, const Buffer& disparity, const Buffer& filled);

  private:
    StereoLayout layout_;
    Program program_;
};

}  // namespace vantage
