#pragma once

#include <vector>

#include "common/gl/buffer.h"
#include "common/gl/program.h"
#include "rig_firmware/stereo/pass_profiler.h"
#include "rig_firmware/stereo/passes/feature_pass.h"
#include "rig_firmware/stereo/passes/perm_reference.h"
#include "rig_firmware/stereo/passes/stereo_layout.h"

namespace vantage {

/// Cost, permeability aggregation and winner takes all over the whole search range. The cost volume
/// is only ever a slab of 16 disparities: aggregation does not mix disparities, so that slabs
/// follow one another and only the winner so far stays. After C. Cigla, A. A. Alatan, "Information
/// permeability for stereo matching", Signal Processing: Image Communication 28 (2013).
class PermPass {
  public:
    PermPass(const ShaderLibrary& library, const StereoLayout& layout, int disparities);

    void run(PassProfiler& profiler, const FeaturePass& features);

    /// uvec2 a pixel in blocks (StereoLayout), see perm_columns.comp.
    const Buffer& winners() const { return winners_; }
    /// uint a pixel: what a pixel's sums are divided by before pixels are compared.
    const Buffer& weight() const { return weight_; }
    std::size_t volume_bytes() const { return volume_.bytes() + down_.bytes(); }
    std::size_t gpu_bytes() const { return volume_bytes() + winners_.bytes() + weight_.bytes(); }

  private:
    void run_line_pass(Program& program, int lines, int first_disparity);

    StereoLayout layout_;
    int disparities_;
    Program rows_, full_columns_, last_columns_, weight_rows_, weight_columns_;
    Buffer volume_, down_, winners_, weight_;
};

}  // namespace vantage
