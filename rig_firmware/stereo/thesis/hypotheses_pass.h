#pragma once

#include "rig_firmware/stereo/thesis/cost_volume.h"
#include "rig_firmware/stereo/thesis/storage_pass.h"

namespace vantage::thesis {

/// The cost of every disparity hypothesis: absolute difference of left (x, y) and right (x - d, y).
class HypothesesPass {
  public:
    HypothesesPass(const ShaderLibrary& library, cv::Size size, int disparities);
    /// left, right: a word a pixel. Fills `slices` slices of `costs` (cost_volume.h) with the
    /// disparities from first_disparity on, a multiple of disparities_per_slice.
    void run(const Buffer& left, const Buffer& right, int first_disparity, int slices,
             const Buffer& costs);
    PassCost cost(int slices) const;

  private:
    StoragePass pass_;
    int disparities_;
};

}  // namespace vantage::thesis
