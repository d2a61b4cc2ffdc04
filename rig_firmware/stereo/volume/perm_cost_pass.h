#pragma once

#include "common/gl/objects/program.h"
#include "rig_firmware/stereo/features/feature_pass.h"
#include "rig_firmware/stereo/pass_profiler.h"
#include "rig_firmware/stereo/volume/stereo_layout.h"

namespace vantage {

/// Matching costs of every pixel and disparity in the form of PermCosts::given. For GPUs with few
/// registers per lane, which compute costs and aggregate them in two passes.
class PermCostPass {
  public:
    PermCostPass(const ShaderLibrary& library, const StereoLayout& layout, int disparities);

    /// costs: PermPass::costs().
    void run(PassProfiler& profiler, const FeaturePass& features, const Buffer& costs);

  private:
    StereoLayout layout_;
    int disparities_;
    Program program_;
};

}  // namespace vantage
