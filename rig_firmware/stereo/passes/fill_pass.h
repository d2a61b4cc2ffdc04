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

    /// disparity in LeftRightPass's form; the result has it too.
    void run(PassProfiler& profiler, const Buffer& disparity);

    const Buffer& filled() const { return filled_; }
    std::size_t gpu_bytes() const { return filled_.bytes(); }

  private:
    StereoLayout layout_;
    Program program_;
    Buffer filled_;
};

}  // namespace vantage
