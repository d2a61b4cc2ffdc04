#pragma once

#include "common/image/image.h"

namespace vantage {

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
