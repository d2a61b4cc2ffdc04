#pragma once

#include "common/gl/objects/buffer.h"
#include "common/gl/objects/program.h"
#include "rig_firmware/stereo/pass_profiler.h"
#include "rig_firmware/stereo/volume/lane_mapping.h"
#include "rig_firmware/stereo/volume/stereo_layout.h"

namespace vantage {

/// Leaves only the disparities that enough pixels around them share, so that FillPass does not
/// spread what an occluded stripe matched by chance.
class SupportPass {
  public:
    /// Pixels of 25, itself among them, that must be within a pixel of a disparity for it to stay.
    static constexpr int min_support = 12;

    /// lanes: changes the time that it takes, and no bit of the result.
    SupportPass(const ShaderLibrary& library, const StereoLayout& layout,
                LaneMapping lanes = lane_mapping_here());

    /// Both in LeftRightPass's form.
    void run(PassProfiler& profiler, const Buffer& disparity, const Buffer& supported);

  private:
    StereoLayout layout_;
    Program program_;
};

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
