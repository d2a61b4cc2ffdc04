#pragma once

#include "common/gl/buffer.h"
#include "common/gl/program.h"
#include "common/gl/texture.h"
#include "rig_firmware/stereo/pass_profiler.h"
#include "rig_firmware/stereo/passes/stereo_layout.h"

namespace vantage {

/// Luma of both pictures and behind it, in a plane of its own, their colour: half of red - blue,
/// from 128 up. Four pixels a word (see StereoLayout).
class LumaPass {
  public:
    LumaPass(const ShaderLibrary& library, const StereoLayout& layout);

    /// From rgba8 textures of the layout's size.
    void run(PassProfiler& profiler, const Texture& left, const Texture& right);

    const Buffer& left() const { return left_; }
    const Buffer& right() const { return right_; }
    std::size_t gpu_bytes() const { return left_.bytes() + right_.bytes(); }

  private:
    StereoLayout layout_;
    Program program_;
    Buffer left_, right_;
};

}  // namespace vantage
