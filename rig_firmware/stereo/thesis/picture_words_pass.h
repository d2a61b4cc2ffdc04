#pragma once

#include "common/gl/objects/texture.h"
#include "rig_firmware/stereo/thesis/storage_pass.h"

namespace vantage::thesis {

/// Copies an rgba8 texture into a storage buffer, a word a pixel, as ColourImage lies in memory.
class PictureWordsPass {
  public:
    PictureWordsPass(const ShaderLibrary& library, cv::Size size);
    void run(const Texture& picture, const Buffer& words);
    PassCost cost() const { return pass_cost(8 * pass_.pixels(), 8 * pass_.pixels()); }

  private:
    StoragePass pass_;
};

}  // namespace vantage::thesis
