#pragma once

#include <optional>
#include <vector>

#include "calib_tools/colour/colour_match.h"
#include "common/image/image.h"

namespace vantage {

/// Published sRGB colours (D65) of the 24 patches of the classic ColorChecker, row by row from dark
/// skin to black.
std::vector<Eigen::Vector3d> chart_colours();

/// Finds the chart in an image (OpenCV's mcc) and measures its patches. Empty if there is none.
std::optional<std::vector<ColourPatch>> find_chart(const ColourImage& picture);

}  // namespace vantage
