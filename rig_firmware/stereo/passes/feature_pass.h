#pragma once

#include "common/gl/buffer.h"
#include "common/gl/program.h"
#include "common/gl/texture.h"
#include "rig_firmware/stereo/pass_profiler.h"
#include "rig_firmware/stereo/passes/feature_reference.h"
#include "rig_firmware/stereo/passes/stereo_layout.h"

namespace vantage {

/// What the matching passes look at: luma, feature words of both pictures, permeability of the left
/// one.
class FeaturePass {
  public:
    FeaturePass(const ShaderLibrary& library, const StereoLayout& layout, double sigma);

    /// From rgba8 textures of the layout's size.
    void run(PassProfiler& profiler, const Texture& left, const Texture& right);
    /// From the luma of a layout of twice this size.
    void run_halved(PassProfiler& profiler, const FeaturePass& fine);

    const Buffer& left_luma() const { return left_luma_; }
    const Buffer& left_features() const { return left_features_; }
    const Buffer& right_features() const { return right_features_; }
    const Buffer& permeability() const { return permeability_; }
    const StereoLayout& layout() const { return layout_; }
    std::size_t gpu_bytes() const;

  private:
    void derive(PassProfiler& profiler);
    void features(const Buffer& luma, const Buffer& words);

    StereoLayout layout_;
    Program luma_program_, halve_program_, features_program_, median_program_,
        permeability_program_;
    Buffer left_luma_, right_luma_, guide_, left_features_, right_features_, permeability_, table_;
};

}  // namespace vantage
