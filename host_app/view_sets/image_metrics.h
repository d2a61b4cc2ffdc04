#pragma once

#include "common/image/image.h"

namespace vantage {

/// The largest ratio that is reported, for pictures that are equal.
inline constexpr double max_psnr_db = 100;

/// Peak signal-to-noise ratio over R, G and B of all pixels, peak 255; of those where `mask` is not
/// zero, if a mask is given. Preconditions: equal sizes. 0 if the mask leaves no pixel.
double psnr_db(const ColourImage& a, const ColourImage& b, const cv::Mat1b& mask = {});

/// Mean structural similarity (Wang et al., 2004) of the luma (BT.601, not rounded): Gaussian
/// window 11x11, sigma 1.5, K1 = 0.01, K2 = 0.03, over the pixels whose window lies inside the
/// picture (all, with mirrored borders, in pictures smaller than a window).
double ssim(const ColourImage& a, const ColourImage& b);

/// The share of pixels that a rig saw: alpha of 128 and above (see Synthesiser).
double coverage(const ColourImage& rendered);
/// The share of pixels that no rig sees now, but one saw before (remembered_alpha).
double remembered(const ColourImage& rendered);
cv::Mat1b covered_mask(const ColourImage& rendered);

/// Mean absolute difference of R, G and B, 0..255, over the pixels where `mask` is not zero; 0 if
/// it leaves none.
double mean_error(const ColourImage& a, const ColourImage& b, const cv::Mat1b& mask);

/// 255 within half of `width_px` of a depth edge (where neighbours' depths differ by more than 5
/// %), where halos are.
cv::Mat1b depth_edge_band(const DepthImage& depth_m, int width_px);

/// The difference for a person to look at: |a - b| * gain per channel.
ColourImage difference_picture(const ColourImage& a, const ColourImage& b, double gain = 4);

}  // namespace vantage
