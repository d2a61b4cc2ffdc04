#pragma once

#include "common/image/image.h"
#include "tests/references/stereo/exposure_reference.h"

namespace vantage {

/// CPU reference of TemporalPass, bit for bit.
class TemporalReference {
  public:
    DisparityImage run(const DisparityImage& disparity, const GreyImage& luma);

  private:
    cv::Mat1i mean_;  ///< 1/1024 px
    cv::Mat1i votes_;
    GreyImage luma_;  ///< mean, a quarter of the way to the new one
    ExposureReference exposure_;
};

}  // namespace vantage
