#pragma once

#include "common/image/image.h"

namespace vantage {

/// Lumas and feature words of the full-size pair, as far as upsampling looks at them.
struct FinePictures {
    GreyImage left_luma;
    cv::Mat1i left_features, right_features;
};

/// CPU form of UpsamplePass. `coarse_luma` is halved(fine.left_luma).
DisparityImage upsampled(const DisparityImage& coarse, const GreyImage& coarse_luma,
                         const FinePictures& fine);

}  // namespace vantage
