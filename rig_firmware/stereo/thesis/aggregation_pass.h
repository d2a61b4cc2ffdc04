#pragma once

#include "rig_firmware/stereo/thesis/cost_volume.h"
#include "rig_firmware/stereo/thesis/storage_pass.h"

namespace vantage::thesis {

/// One pass of gradient-guided aggregation (Gong & Yang 2005, as the thesis describes it): a mean
/// over the 3x3 neighbourhood whose weights come from a table by the discontinuities around, so
/// that neighbours beyond one are left out. Applied repeatedly.
class AggregationPass {
  public:
    AggregationPass(const ShaderLibrary& library, cv::Size size);
    /// Cost volumes as in cost_volume.h; `discontinuities` as DiscontinuityPass writes them.
    void run(const Buffer& costs, const Buffer& discontinuities, int slices,
             const Buffer& aggregated);
    PassCost cost(int slices) const;

  private:
    StoragePass pass_;
};

}  // namespace vantage::thesis
