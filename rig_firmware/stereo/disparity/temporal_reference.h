#pragma once

#include "common/image/image.h"
#include "rig_firmware/stereo/disparity/exposure_reference.h"

namespace vantage {

// When a pixel of TemporalPass is still, in grey levels that the five pixels of a cross differ by
// from their running mean, all together. Noise of two grey levels makes 6 of them.
inline constexpr int most_still_change = 40;
inline constexpr int most_holding_change = 20;  ///< while it is held against another disparity
/// 1/1024 px that disparities may differ by which agree.
inline constexpr int most_agreeing_step = 1536;
// Votes: what a frame that agrees adds, where one that does not takes 1; what a disparity begins
// with that others gave way to; and how many there may be.
inline constexpr int agreeing_votes = 2, first_votes = 4, most_votes = 15;

/// CPU form of TemporalPass, bit for bit.
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
