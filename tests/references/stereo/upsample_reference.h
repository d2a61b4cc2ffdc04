#pragma once

#include "common/image/image.h"

namespace vantage {

/// CPU reference of UpsamplePass. `coarse_luma` is halved(fine_luma).
DisparityImage upsampled(const DisparityImage& coarse, const GreyImage& coarse_luma,
                         const GreyImage& fine_luma);

}  // namespace vantage
