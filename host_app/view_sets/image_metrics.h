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

/// Quality measures for rendered views from MPEG immersive video, which ignore shifts of up to two
/// pixels and a small constant difference of colour: IV-PSNR (Dziembowski et al., "IV-PSNR - the
/// objective quality metric for immersive video applications", 2022) and IV-SSIM (Dziembowski et
/// al., "IV-SSIM - the structural similarity metric for immersive video", 2024).
///
/// Both compare full-range Y'CbCr of BT.709, rounded to 8 bits. Each pixel of one image is compared
/// with the most similar pixel within 5x5 of the other image, whose border pixels are repeated, and
/// the components count 4:1:1. A constant difference of up to 1 % of the range is removed first.
/// Each measure is the smaller of its two directions. The reference software QMIV computes the same
/// with its default settings and a conversion to YCbCr_BT709.
struct ImmersiveMetrics {
    double iv_psnr_db = 0;  ///< of 8 bits; equal images give the value of a squared error of 1
    double iv_ssim = 0;     ///< of blocks of 8x8 pixels, 4 pixels apart
};

/// Compares two images. With a mask, only its pixels that are not 0 count for IV-PSNR and the
/// difference of colour, and only blocks that lie in it by half or more for IV-SSIM; 0 without any.
/// Precondition: equal sizes, at least 8x8.
ImmersiveMetrics immersive_metrics(const ColourImage& a, const ColourImage& b,
                                   const cv::Mat1b& mask = {});

}  // namespace vantage
