#pragma once

#include <cstddef>
#include <optional>

#include "calib_tools/bundle/bundle.h"
#include "common/board/board_pattern.h"

namespace vantage {

/// Next image of the board that would reduce the uncertainty of the stage most, and the two rigs
/// that have to see it.
struct NextPicture {
    std::size_t a = 0, b = 0;
    std::size_t rig = 0;      ///< rig whose pose gains most
    double sigma_now_m = 0;   ///< current uncertainty of that pose
    double sigma_then_m = 0;  ///< predicted uncertainty
};

/// Predicts, for every two rigs, the uncertainties after one more view of a large, tilted board in
/// their common view. Returns the two rigs whose variances decrease most. Cameras 2i and 2i + 1
/// belong to rig i; `board` is the number of the pattern in the bundle's faces. Empty if no two
/// rigs can see a board together.
std::optional<NextPicture> most_helpful_picture(const Bundle& bundle, const BundleUncertainty& now,
                                                const BoardPattern& pattern, int board);

}  // namespace vantage
