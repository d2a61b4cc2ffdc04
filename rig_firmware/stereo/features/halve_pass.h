#pragma once

#include "common/gl/objects/buffer.h"
#include "common/gl/objects/program.h"
#include "rig_firmware/stereo/pass_profiler.h"
#include "rig_firmware/stereo/volume/stereo_layout.h"

namespace vantage {

/// Half of a size, rounded up.
constexpr StereoLayout halved(const StereoLayout& layout) {
    return {(layout.width_px + 1) / 2, (layout.height_px + 1) / 2};
}

/// Half of the rows, rounded up.
constexpr StereoLayout with_half_the_rows(const StereoLayout& layout) {
    return {layout.width_px, (layout.height_px + 1) / 2};
}

enum class HalvedSides { both, height };

/// Luma and colour at half the size, the mean of 2x2 pixels, or of half the rows, the mean of two.
class HalvePass {
  public:
    HalvePass(const ShaderLibrary& library, const StereoLayout& fine,
              HalvedSides sides = HalvedSides::both);

    /// fine_luma: in LumaPass's form.
    void run(PassProfiler& profiler, const Buffer& fine_luma);

    /// In LumaPass's form.
    const Buffer& luma() const { return luma_; }
    std::size_t gpu_bytes() const { return luma_.bytes(); }

  private:
    StereoLayout fine_, coarse_;
    Program program_;
    Buffer luma_;
};

}  // namespace vantage
