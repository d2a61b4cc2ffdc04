#pragma once

#include "common/gl/objects/program.h"
#include "rig_firmware/stereo/features/feature_pass.h"
#include "rig_firmware/stereo/pass_profiler.h"
#include "rig_firmware/stereo/volume/dispatch_parts.h"
#include "rig_firmware/stereo/volume/lane_mapping.h"
#include "rig_firmware/stereo/volume/stereo_layout.h"

namespace vantage {

/// Rows of the pictures for each row of costs.
enum class CostRows {
    all,    ///< one
    pairs,  ///< two, whose costs are averaged
};

/// Matching costs in the form of PermCosts::given, in a pass of their own: where rows are taken in
/// pairs, and for GPUs with too few registers per lane to compute costs within the aggregation.
class PermCostPass {
  public:
    /// layout: of the pictures. lanes and max_operations (of one dispatch) change the time that it
    /// takes, and no bit of the result.
    PermCostPass(const ShaderLibrary& library, const StereoLayout& layout, int disparities,
                 CostRows rows = CostRows::all, LaneMapping lanes = lane_mapping_here(),
                 double max_operations = max_dispatch_operations);

    /// costs: PermPass::costs().
    void run(PassProfiler& profiler, const FeaturePass& features, const Buffer& costs);

  private:
    StereoLayout layout_, cost_layout_;
    int disparities_;
    CostRows rows_;
    double max_operations_;
    Program program_;
};

}  // namespace vantage
