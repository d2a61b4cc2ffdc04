#pragma once

#include "rig_firmware/stereo/disparity/exposure_reference.h"
#include "rig_firmware/stereo/disparity/feature_reference.h"

namespace vantage {

/// CPU form of what LumaPass does to a stream of pictures, bit for bit: where luma and colour lie
/// near their running mean, exposed as the picture is, the mean takes their place, a half, a
/// quarter, at last an eighth of the way to the new value; elsewhere the mean begins anew.
class StreamAverage {
  public:
    /// Grey levels that a still pixel may lie off its mean: five times a sensor's noise of two.
    static constexpr int most_noise = 10;

    StereoPlanes run(const ColourImage& picture);

  private:
    ExposureReference exposure_;
    cv::Mat1i luma_64_, colour_64_;  ///< means, 1/64 grey level
    cv::Mat1i frames_;               ///< that they are of, up to four
};

}  // namespace vantage
