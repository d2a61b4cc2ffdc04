#pragma once

#include <cstddef>
#include <optional>

#include "calib_tools/board/board_pattern.h"
#include "calib_tools/bundle/bundle.h"

namespace vantage {

/// One more picture of the board: before which two rigs it would make the stage most certain.
struct NextPicture {
    std::size_t a = 0, b = 0;
    std::size_t rig = 0;      ///< whose place gains most by it
    double sigma_now_m = 0;   ///< of that place
    double sigma_then_m = 0;  ///< as predicted
};

/// Predicts, for every two rigs, what the uncertainties would be if both saw the board once more,
/// large and tilted, where they look at, and chooses the two that lower the rigs' variances most.
/// Cameras 2i and 2i + 1 are of rig i; `board` is the number of the pattern in the bundle's faces.
/// Empty if no two rigs see a board together there.
std::optional<NextPicture> most_helpful_picture(const Bundle& bundle, const BundleUncertainty& now,
                                                const BoardPattern& pattern, int board);

}  // namespace vantage
