#pragma once

#include <array>
#include <cstdint>

#include <opencv2/core.hpp>

#include "common/image/image.h"

namespace vantage {

// Plain CPU forms of the passes of FeaturePass, bit for bit.

/// 27 census bits (an odd chessboard of 9x7 without corners) below 5 bits of clamped horizontal
/// gradient.
cv::Mat1i feature_words(const GreyImage& luma);

/// How many rows lower than it should the right picture lies, -2..2, by FeaturePass's votes.
int row_shift(const cv::Mat1i& left_features, const cv::Mat1i& right_features, int disparities);

/// The picture moved up by so many rows, the last one repeated.
GreyImage rows_shifted(const GreyImage& luma, int shift);

/// 3x3 median, edges repeated.
GreyImage guide_of(const GreyImage& luma);

/// Rounded mean of 2x2; an odd last row or column counts twice (columns: within the padded word).
GreyImage halved(const GreyImage& luma);

/// Sixteenths of a sum that pass a step of 0..255 grey levels of the guide: 16 exp(-step / sigma),
/// at most 15.
using PermeabilityTable = std::array<std::uint32_t, 256>;
PermeabilityTable permeability_table(double sigma);

/// Per pixel: bits 0-3 from the left neighbour, bits 4-7 from the upper one; 0 at the edges.
cv::Mat1b permeability_of(const GreyImage& guide, const PermeabilityTable& table);

}  // namespace vantage
