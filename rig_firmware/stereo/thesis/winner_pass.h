#pragma once

#include "rig_firmware/stereo/thesis/cost_volume.h"
#include "rig_firmware/stereo/thesis/storage_pass.h"

namespace vantage::thesis {

/// Winner takes all. The volume may come in batches of slices; `keys` (a word a pixel) keeps
/// (cost << 8) | disparity of the cheapest hypothesis so far.
class WinnerPass {
  public:
    WinnerPass(const ShaderLibrary& library, cv::Size size);
    /// costs: `slices` slices (cost_volume.h) from first_disparity on; 0 starts afresh.
    void run(const Buffer& costs, int first_disparity, int slices, const Buffer& keys);
    PassCost cost(int slices) const;

  private:
    StoragePass pass_;
};

}  // namespace vantage::thesis
