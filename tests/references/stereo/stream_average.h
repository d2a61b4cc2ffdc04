#pragma once

#include "tests/references/stereo/exposure_reference.h"
#include "tests/references/stereo/feature_reference.h"

namespace vantage {

/// CPU reference of what LumaPass does to a stream of pictures, bit for bit: where luma and colour
/// lie near their running mean, exposed as the picture is, the mean takes their place, a half, a
/// quarter, at last an eighth of the way to the new value; elsewhere the mean begins anew.
class StreamAverage {
  public:
    StereoPlanes run(const ColourImage& picture);

  private:
    ExposureReference exposure_;
    cv::Mat1i luma_64_, colour_64_;  ///< means, 1/64 grey level
    cv::Mat1i frames_;               ///< that they are of, up to four
};

}  // namespace vantage
