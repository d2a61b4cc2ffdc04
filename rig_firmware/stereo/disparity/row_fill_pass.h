#pragma once

#include "common/gl/objects/buffer.h"
#include "common/gl/objects/program.h"
#include "rig_firmware/stereo/disparity/support_pass.h"
#include "rig_firmware/stereo/pass_profiler.h"
#include "rig_firmware/stereo/volume/stereo_layout.h"

namespace vantage {

/// Makes disparity dense from the background side, row by row, without spreading what stands alone;
/// confidence of what it fills is 0. Where its time matters more than what one camera alone sees:
/// see PathFillPass.
class RowFillPass {
  public:
    RowFillPass(const ShaderLibrary& library, const StereoLayout& layout);

    /// Both in LeftRightPass's form.
    void run(PassProfiler& profiler, const Buffer& disparity, const Buffer& filled);

  private:
    StereoLayout layout_;
    SupportPass support_;
    Program program_;
};

}  // namespace vantage
