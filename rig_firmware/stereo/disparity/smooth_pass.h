#pragma once

#include "common/gl/objects/buffer.h"
#include "common/gl/objects/program.h"
#include "common/image/image.h"
#include "rig_firmware/stereo/pass_profiler.h"
#include "rig_firmware/stereo/volume/lane_mapping.h"
#include "rig_firmware/stereo/volume/stereo_layout.h"

namespace vantage {

/// Takes sub-pixel noise out of slanted surfaces without rounding edges: a mean over opposite
/// neighbours that are both near in disparity, along rows, then along columns.
class SmoothPass {
  public:
    /// most_step: see smoothed_where_near. lanes: changes the time that it takes, and no bit of the
    /// result.
    SmoothPass(const ShaderLibrary& library, const StereoLayout& layout,
               int most_step = disparity_steps_per_px, LaneMapping lanes = lane_mapping_here());

    /// disparity in LeftRightPass's form; its contents are replaced. Unknown stays unknown, and
    /// confidence as it is.
    void run(PassProfiler& profiler, const Buffer& disparity);

    std::size_t gpu_bytes() const { return along_rows_.bytes(); }

  private:
    StereoLayout layout_;
    Program rows_, columns_;
    Buffer along_rows_;
};

}  // namespace vantage
