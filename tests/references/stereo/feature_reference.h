#pragma once

#include <opencv2/core.hpp>

#include "common/image/image.h"
#include "rig_firmware/stereo/features/permeability_pass.h"

namespace vantage {

// Plain CPU forms of the passes of FeaturePass, bit for bit.

/// What of a picture LumaPass leaves: luma, and half of red - blue from 128 up.
struct StereoPlanes {
    GreyImage luma, colour;
};
StereoPlanes planes_of(const ColourImage& picture);

/// 17 census bits (an odd chessboard of 7x5 without a corner) below 5 bits each of vertical
/// gradient, colour and horizontal gradient, modulo 32.
cv::Mat1i feature_words(const StereoPlanes& picture);

/// How many rows lower than it should the right picture lies, -2..2, by FeaturePass's votes.
int row_shift(const cv::Mat1i& left_features, const cv::Mat1i& right_features, int disparities);

/// The picture moved up by so many rows, the last one repeated.
StereoPlanes rows_shifted(const StereoPlanes& picture, int shift);

/// 3x3 median, edges repeated.
StereoPlanes guide_of(const StereoPlanes& picture);

/// Rounded mean of 2x2; an odd last row or column counts twice (columns: within the padded word).
GreyImage halved(const GreyImage& luma);
StereoPlanes halved(const StereoPlanes& picture);
/// The same with HalvedSides::height.
StereoPlanes with_half_the_rows(const StereoPlanes& picture);

/// Per pixel: bits 0-3 from the left neighbour, bits 4-7 from the upper one; 0 at the edges.
cv::Mat1b permeability_of(const StereoPlanes& guide, const PermeabilityTable& table);

}  // namespace vantage
