#pragma once

#include <array>

#include <Eigen/Core>

#include "common/image/image.h"

namespace vantage {

/// Share of the pixels inside a quadrangle (its corners in order, in pixels) that have the highest
/// value, as glare on a board has. 0 if the quadrangle is outside the image.
double burnt_out_share(const GreyImage& picture, const std::array<Eigen::Vector2d, 4>& outline);

}  // namespace vantage
