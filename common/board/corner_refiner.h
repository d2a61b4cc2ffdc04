#pragma once

#include <optional>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "common/image/image.h"

namespace vantage {

/// Model of the image around one corner of a chessboard: two straight edges that cross, blurred by
/// the lens, in light that changes linearly.
struct CornerFit {
    Eigen::Vector2d pixel;  ///< crossing of the edges
    double blur_px = 0;     ///< Gaussian sigma of the edges
    double contrast = 0;    ///< half the step from black to white in grey levels
    double residual = 0;    ///< RMS of image minus model in grey levels
};

/// Fits  mean + slope . d + contrast * erf(d1 / (sqrt2 blur)) * erf(d2 / (sqrt2 blur))  by
/// Levenberg-Marquardt to the pixels within radius_px of `start`; d1 and d2 are the distances from
/// the two edges. Straight lines stay straight in perspective, so that the crossing is unbiased for
/// tilted boards. The fit uses every pixel of the edges; a search for orthogonal gradients does
/// not. `along_row` and `along_column` are the approximate directions of the edges. Empty if the
/// fit diverges or there is no corner.
std::optional<CornerFit> fit_corner(const GreyImage& picture, const Eigen::Vector2d& start,
                                    const Eigen::Vector2d& along_row,
                                    const Eigen::Vector2d& along_column, double radius_px);

}  // namespace vantage
