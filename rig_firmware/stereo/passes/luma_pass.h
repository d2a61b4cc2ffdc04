#pragma once

#include "common/gl/buffer.h"
#include "common/gl/program.h"
#include "common/gl/texture.h"
#include "rig_firmware/stereo/pass_profiler.h"
#include "rig_firmware/stereo/passes/stereo_layout.h"

namespace vantage {

/// Luma of both pictures, four pixels a word (see StereoLayout).
class LumaPass {
  public:
    LumaPass(const ShaderLibrary& library, const StereoLayout& layout);

    /// From rgba8 textures of the layout's size.
    void run(PassProfiler& profiler, const Texture& left, const Texture& right);
    /// From a layout of twice this size (rounded up), the right picture with its rows put where
    /// FeaturePass's votes say that they should lie.
    void run_halved(PassProfiler& profiler, const LumaPass& fine, const Buffer& row_shift_votes);

    const Buffer& left() const { return left_; }
    const Buffer& right() const { return right_; }
    std::size_t gpu_bytes() const { return left_.bytes() + right_.bytes(); }

  private:
    StereoLayout layout_;
    Program luma_program_, halve_program_, halve_shifted_program_;
    Buffer left_, right_;
};

}  // namespace vantage
