#pragma once

#include "common/gl/objects/buffer.h"
#include "common/gl/objects/program.h"
#include "rig_firmware/stereo/disparity/result_pass.h"
#include "rig_firmware/stereo/pass_profiler.h"
#include "rig_firmware/stereo/volume/stereo_layout.h"

namespace vantage {

/// Disparity of half the rows to all rows: on the line through the two nearest coarse rows where
/// they are near each other; else each pixel takes that of the one that looks more like it, so that
/// depth edges move to where they are.
class UpsampleRowsPass {
  public:
    /// fine: the size of the result; the coarse one is with_half_the_rows(fine).
    UpsampleRowsPass(const ShaderLibrary& library, const StereoLayout& fine,
                     DisparityForm form = DisparityForm::words);

    /// Disparity in LeftRightPass's form, lumas in LumaPass's.
    void run(PassProfiler& profiler, const Buffer& coarse_disparity, const Buffer& coarse_luma,
             const Buffer& fine_luma);

    const Buffer& disparity() const { return disparity_; }
    std::size_t gpu_bytes() const { return disparity_.bytes(); }

  private:
    StereoLayout fine_;
    DisparityForm form_;
    Program program_;
    Buffer disparity_;
};

}  // namespace vantage
