#pragma once

#include "common/gl/objects/buffer.h"
#include "common/gl/objects/program.h"
#include "rig_firmware/stereo/disparity/result_pass.h"
#include "rig_firmware/stereo/pass_profiler.h"
#include "rig_firmware/stereo/volume/stereo_layout.h"

namespace vantage {

/// Disparity of the half-size pair to full size: on the plane through the neighbours where they are
/// all near; else each pixel takes that of the one neighbour that is near and looks like it, so
/// that depth edges move to where they are. After J. Kopf et al., "Joint bilateral upsampling",
/// SIGGRAPH 2007, with one neighbour in place of the mean, because a mean of two surfaces is on
/// neither.
class UpsamplePass {
  public:
    UpsamplePass(const ShaderLibrary& library, const StereoLayout& coarse, const StereoLayout& fine,
                 DisparityForm form = DisparityForm::words);

    /// Disparity in LeftRightPass's form, lumas in LumaPass's.
    void run(PassProfiler& profiler, const Buffer& coarse_disparity, const Buffer& coarse_luma,
             const Buffer& fine_luma);

    const Buffer& disparity() const { return disparity_; }
    std::size_t gpu_bytes() const { return disparity_.bytes(); }

  private:
    StereoLayout coarse_, fine_;
    DisparityForm form_;
    Program program_;
    Buffer disparity_;
};

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
