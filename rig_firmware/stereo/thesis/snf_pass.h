#pragma once

#include "rig_firmware/stereo/thesis/storage_pass.h"

namespace vantage::thesis {

/// One iteration of symmetric neighbourhood filtering (Harwood et al. 1987): edges stay sharp,
/// texture noise goes. Buffers hold a word a pixel.
class SnfPass {
  public:
    SnfPass(const ShaderLibrary& library, cv::Size size);
    void run(const Buffer& source, const Buffer& filtered);
    PassCost cost() const { return pass_cost(8 * pass_.pixels(), 130 * pass_.pixels()); }

  private:
    StoragePass pass_;
};

}  // namespace vantage::thesis
