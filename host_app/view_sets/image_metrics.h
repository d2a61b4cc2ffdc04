#pragma once

#include "common/image/image.h"

namespace vantage {

/// The largest reported ratio, for equal images.
inline constexpr double max_psnr_db = 100;

/// Peak signal-to-noise ratio over R, G and B, peak 255, of all pixels or of those where `mask` is
/// not zero. Precondition: equal sizes. 0 if the mask is empty.
double psnr_db(const ColourImage& a, const ColourImage& b, const cv::Mat1b& mask = {});

/// Mean structural similarity (Wang et al., 2004) of the luma (BT.601, not rounded): Gaussian
/// window 11x11, sigma 1.5, K1 = 0.01, K2 = 0.03, over the pixels whose window is inside the image;
/// over all pixels, with mirrored borders, in images smaller than a window.
double ssim(const ColourImage& a, const ColourImage& b);

/// The share of pixels that a rig sees: alpha of at least 128 (see Synthesiser).
double coverage(const ColourImage& rendered);
/// The share of pixels that no rig sees now, but one saw before (remembered_alpha).
double remembered(const ColourImage& rendered);
cv::Mat1b covered_mask(const ColourImage& rendered);

/// Mean absolute difference of R, G and B, 0..255, where `mask` is not zero; 0 if it is empty.
double mean_error(const ColourImage& a, const ColourImage& b, const cv::Mat1b& mask);

/// 255 within half of `width_px` of a depth edge, where halos occur. At an edge, the depths of
/// neighbours differ by more than 5 %.
cv::Mat1b depth_edge_band(const DepthImage& depth_m, int width_px);

/// The difference image for people: |a - b| * gain per channel.
ColourImage difference_picture(const ColourImage& a, const ColourImage& b, double gain = 4);

}  // namespace vantage
