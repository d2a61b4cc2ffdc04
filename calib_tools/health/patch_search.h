#pragma once

#include <optional>

#include <Eigen/Core>

#include "common/image/image.h"

namespace vantage {

/// Finds the best match of a patch in `area` by normalised correlation. Returns its upper left
/// pixel, to a fraction of a pixel. Empty if the correlation is below `fewest`, if the match is at
/// the border, or if another place matches nearly as well.
std::optional<Eigen::Vector2d> find_patch(const GreyImage& area, const GreyImage& patch,
                                          double fewest);

}  // namespace vantage
