#pragma once

#include "common/image/image.h"

namespace vantage {

/// CPU form of TemporalPass, bit for bit.
class TemporalReference {
  public:
    DisparityImage run(const DisparityImage& disparity, const GreyImage& luma);

  private:
    cv::Mat1i mean_;  ///< 1/8192 px
    GreyImage luma_;
};

}  // namespace vantage
