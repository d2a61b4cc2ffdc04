#pragma once

#include "rig_firmware/stereo/thesis/storage_pass.h"

namespace vantage::thesis {

/// The binary discontinuity map: the greatest gradient of the three channels, thresholded, towards
/// each of the four neighbours. Kept per side, since aggregation asks which neighbours lie beyond.
/// `picture` and the map hold a word a pixel; bits as in Discontinuity.
class DiscontinuityPass {
  public:
    DiscontinuityPass(const ShaderLibrary& library, cv::Size size);
    void run(const Buffer& picture, int threshold, const Buffer& discontinuities);
    PassCost cost() const { return pass_cost(8 * pass_.pixels(), 60 * pass_.pixels()); }

  private:
    StoragePass pass_;
};

}  // namespace vantage::thesis
