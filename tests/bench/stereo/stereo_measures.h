#pragma once

#include <vector>

#include "tests/bench/stereo/filmed_pair.h"

namespace vantage {

/// How far disparities lie from the truth on slanted planes that have a texture along their rows.
struct SubpixelError {
    int judged = 0;     ///< pixels of such planes, right of column `disparities`
    int inliers = 0;    ///< of them, less than a pixel off
    double rms_px = 0;  ///< of the inliers
};

/// A plane fits the 11x11 pixels around every judged one to 0.02 px, and rises by at least a
/// hundredth of a pixel a pixel; grey levels change by at least 4 a pixel (RMS) along the rows of
/// 9x7. found_px: 0 = unknown.
SubpixelError subpixel_error_on_slants(const cv::Mat1f& found_px, const FilmedPair& pair,
                                       int disparities);

/// Grey levels a pixel, mean length of the gradient over 9x9 pixels, below which a surface counts
/// as plain.
inline constexpr float most_plain_gradient = 4;

/// 255 where a surface is plain.
cv::Mat1b plain_pixels(const GreyImage& luma);

/// 255 where the right camera sees what the left one does, by the left one's exact disparity.
cv::Mat1b seen_by_right(const cv::Mat1f& disparity_px);

/// A pixel of known truth: how sure the matcher was, and whether it erred by more than it may.
struct JudgedPixel {
    int confidence;
    bool is_bad;
};

/// Of the last match of `matcher`, which found found_px, against what is known of the pair.
std::vector<JudgedPixel> judged_pixels(const Matcher& matcher, const cv::Mat1f& found_px,
                                       const FilmedPair& pair, float most_px);

double bad_share(const std::vector<JudgedPixel>& pixels);

/// The share of bad pixels among the most confident n, averaged over n: the area under the
/// sparsification curve (its expectation where pixels are as confident as others). Without a
/// meaning of confidence it is the share of bad pixels.
double sparsification_area(std::vector<JudgedPixel> pixels);

}  // namespace vantage
