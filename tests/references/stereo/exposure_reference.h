#pragma once

#include <vector>

#include "common/image/image.h"

namespace vantage {

/// CPU reference of ExposurePass, bit for bit.
class ExposureReference {
  public:
    /// The brightness of the picture relative to the previous one, in 1/4096; 4096 for the first.
    int gain_4096(const GreyImage& luma);

  private:
    std::vector<int> luma_;
};

/// A luma value, or a mean of luma values in any unit, after a gain; at most `max`.
constexpr int exposed(int luma, int gain_4096, int max) {
    const int result = (luma * gain_4096 + 2048) >> 12;
    return result < max ? result : max;
}

}  // namespace vantage
