#pragma once

#include "common/gl/objects/program.h"
#include "rig_firmware/stereo/features/feature_pass.h"
#include "rig_firmware/stereo/pass_profiler.h"
#include "rig_firmware/stereo/volume/lane_mapping.h"
#include "rig_firmware/stereo/volume/stereo_layout.h"

namespace vantage {

/// Number of half-size disparities: d stands for the full-size 2d - 1 .. 2d + 1.
constexpr int halved_disparities(int disparities) { return (disparities + 1) / 2; }

/// Which full-size pixels of each 2x2 are compared: the upper right one, or the mean of that and
/// the lower left one.
enum class HalvedCostSamples { one, two };

/// Matching costs on a grid of half the size (a quarter of the pixels, half of the disparities)
/// from the full-size pictures' words: what halving the pictures first would lose, thin things and
/// the places of edges above all, stays.
class HalvedCostPass {
  public:
    /// disparities: of the full size. lanes: changes the time that it takes, and no bit of the
    /// result.
    HalvedCostPass(const ShaderLibrary& library, const StereoLayout& fine, int disparities,
                   HalvedCostSamples samples, LaneMapping lanes = lane_mapping_here());

    /// Leaves in `costs` what PermPass takes as PermCosts::given.
    void run(PassProfiler& profiler, const FeaturePass& fine_features, const Buffer& costs);

  private:
    StereoLayout fine_;
    int disparities_;
    HalvedCostSamples samples_;
    LaneMapping lanes_;
    Program program_;
};

}  // namespace vantage
