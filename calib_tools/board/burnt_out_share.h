#pragma once

#include <array>

#include <Eigen/Core>

#include "common/image/image.h"

namespace vantage {

/// Share of the pixels of the picture inside the quadrangle (its corners in order, pixels) that are
/// as bright as can be: glare on a board. 0 where the quadrangle lies outside the picture.
double burnt_out_share(const GreyImage& picture, const std::array<Eigen::Vector2d, 4>& outline);

}  // namespace vantage
