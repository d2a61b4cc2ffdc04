#pragma once

#include <optional>

#include <Eigen/Core>

#include "common/image/image.h"

namespace vantage {

/// Where in `area` the patch fits best by normalised correlation: its upper left pixel, to a
/// fraction of a pixel. Empty for a fit below `fewest`, at the area's border, or with a rival
/// elsewhere that fits nearly as well and would make it a guess.
std::optional<Eigen::Vector2d> find_patch(const GreyImage& area, const GreyImage& patch,
                                          double fewest);

}  // namespace vantage
