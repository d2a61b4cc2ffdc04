#pragma once

#include "common/image/image.h"

namespace vantage {

/// What RectifyPass computes, on the CPU, bit for bit: `positions` holds for every rectified pixel
/// its (x, y) in `raw` (px, pixel centres at integers); bilinear with positions rounded to
/// 1/256 px; what lies outside of the raw picture, or is not a number, is opaque black.
ColourImage rectify_reference(const ColourImage& raw, const cv::Mat2f& positions);

/// The same of a camera's buffer in YUV: `yuv` holds Y, U, V and 255 for each pixel, chroma as its
/// nearest sample has it. Resampled first, then converted as BT.601 of limited range.
ColourImage rectify_yuv_reference(const ColourImage& yuv, const cv::Mat2f& positions);

}  // namespace vantage
