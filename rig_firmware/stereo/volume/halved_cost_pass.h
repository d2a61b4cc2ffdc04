#pragma once

#include "common/gl/objects/program.h"
#include "rig_firmware/stereo/features/feature_pass.h"
#include "rig_firmware/stereo/pass_profiler.h"
#include "rig_firmware/stereo/volume/dispatch_parts.h"
#include "rig_firmware/stereo/volume/lane_mapping.h"
#include "rig_firmware/stereo/volume/stereo_layout.h"

namespace vantage {

/// Number of half-size disparities: d stands for the full-size 2d - 1 .. 2d + 1.
constexpr int halved_disparities(int disparities) { return (disparities + 1) / 2; }

/// Which full-size pixels of each 2x2 are compared: the mean of the upper right one and the lower
/// left one, or one alone, in even rows the upper right one and in odd rows the lower right one.
/// (Always the upper one would shift edges by half a pixel.)
enum class HalvedCostSamples { one, two };

/// Matching costs on a grid of half the size (a quarter of the pixels, half of the disparities)
/// from the full-size pictures' words: what halving the pictures first would lose, thin things and
/// the places of edges above all, stays.
class HalvedCostPass {
  public:
    /// disparities: of the full size. lanes and max_operations (of one dispatch) change the time
    /// that it takes, and no bit of the result.
    HalvedCostPass(const ShaderLibrary& library, const StereoLayout& fine, int disparities,
                   HalvedCostSamples samples, LaneMapping lanes = lane_mapping_here(),
                   double max_operations = max_dispatch_operations);

    /// Leaves in `costs` what PermPass takes as PermCosts::given.
    void run(PassProfiler& profiler, const FeaturePass& fine_features, const Buffer& costs);

  private:
    StereoLayout fine_;
    int disparities_;
    HalvedCostSamples samples_;
    /// The samples of a 2x2 are compared one after the other where registers have no place for
    /// both.
    int runs_;
    double max_operations_;
    Program program_;
};

}  // namespace vantage
