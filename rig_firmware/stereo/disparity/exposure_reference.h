#pragma once

#include <vector>

#include "common/image/image.h"

namespace vantage {

/// CPU form of ExposurePass, bit for bit.
class ExposureReference {
  public:
    static constexpr int columns = 32, rows = 24;  ///< of the grid of samples
    static constexpr int most_first_step = 24,     ///< grey levels that what counts differs by
        most_step = 8;                             ///< likewise, once a first ratio is known
    static constexpr int least_change = 8;         ///< of a gain, 1/4096; what is less is noise

    /// 1/4096 of how much brighter the picture is than the one before; 4096 at first.
    int gain_4096(const GreyImage& luma);

  private:
    std::vector<int> luma_;
};

/// A luma, or a mean of it in any unit, after a gain.
constexpr int exposed(int luma, int gain_4096, int most) {
    const int result = (luma * gain_4096 + 2048) >> 12;
    return result < most ? result : most;
}

}  // namespace vantage
