#pragma once

#include "common/image/image.h"

namespace vantage {

/// CPU reference of UpsamplePass. `coarse_luma` is halved(fine_luma).
DisparityImage upsampled(const DisparityImage& coarse, const GreyImage& coarse_luma,
                         const GreyImage& fine_luma);

/// CPU reference of UpsampleRowsPass. `coarse_luma` is that of with_half_the_rows().
DisparityImage upsampled_rows(const DisparityImage& coarse, const GreyImage& coarse_luma,
                              const GreyImage& fine_luma);

}  // namespace vantage
