#pragma once

#include <opencv2/calib3d.hpp>

#include "common/image/image.h"

namespace vantage {

enum class OpenCvMode { bm, sgbm_3way, hh4 };

/// OpenCV's matchers as one would use them: grey, block 3 (BM: 15), P1 = 8 * 9, P2 = 32 * 9,
/// uniqueness 10, speckles of up to 100 px dropped, disp12MaxDiff 1; holes filled from the
/// background side (the smaller of the nearest known neighbours in the row).
class OpenCvMatcher {
  public:
    /// prefilter_cap: how far gradients count (SGBM only). 15 errs least where both sensors are
    /// exposed alike, 63 where they are not.
    OpenCvMatcher(OpenCvMode mode, int disparities, int prefilter_cap = 15);

    /// Dense disparity in pixels. `padded`: the pictures are extended to the left by the search
    /// range first, so that OpenCV also judges the columns that it would leave out; slower, better.
    cv::Mat1f match(const GreyImage& left, const GreyImage& right, bool padded);

  private:
    int disparities_;
    cv::Ptr<cv::StereoMatcher> matcher_;
};

}  // namespace vantage
