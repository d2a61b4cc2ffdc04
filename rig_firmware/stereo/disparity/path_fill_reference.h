#pragma once

#include "common/image/image.h"
#include "rig_firmware/stereo/disparity/feature_reference.h"

namespace vantage {

/// Side of the squares in which PathFillPass works.
enum class FillCell { one_px, two_px };
constexpr int px_of(FillCell cell) { return cell == FillCell::one_px ? 1 : 2; }

/// Islands of fewer cells are not spread. Measured roughly: runs of neighbours within a pixel of
/// each other along the rows, added up along the columns.
inline constexpr int least_island_cells = 32;

/// CPU form of PathFillPass, bit for bit.
DisparityImage filled_along_paths(const DisparityImage& disparity, const StereoPlanes& left,
                                  FillCell cell);

}  // namespace vantage
