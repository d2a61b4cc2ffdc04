#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

namespace vantage {

enum class LensModel {
    pinhole,  ///< OpenCV's polynomial/rational/thin-prism/tilted model: 0, 4, 5, 8, 12 or 14
              ///< coefficients
    fisheye,  ///< OpenCV's fisheye (Kannala-Brandt): 4 coefficients
};

/// One camera's intrinsics in OpenCV's conventions: x right, y down, z forward; pixel centres at
/// integer coordinates; origin top-left. `distortion` holds OpenCV's coefficients in OpenCV's
/// order.
struct CameraModel {
    int width_px = 0, height_px = 0;
    double fx_px = 0, fy_px = 0, cx_px = 0, cy_px = 0;
    double skew_px = 0;
    LensModel lens = LensModel::pinhole;
    std::vector<double> distortion;

    Eigen::Matrix3d K() const;

    /// The coefficients as OpenCV's functions take them: four zeros for a fisheye lens that has
    /// none.
    std::vector<double> opencv_distortion() const;

    /// Throws Error naming the first value that cannot be (sizes, focal lengths, coefficient count,
    /// not finite).
    void validate() const;

    /// Camera coordinates (m) to pixel; empty for points at or behind the camera.
    std::optional<Eigen::Vector2d> project(const Eigen::Vector3d& point_m) const;

    /// Pixel to the ray (x, y, 1) in camera coordinates, distortion undone iteratively.
    Eigen::Vector3d unproject(const Eigen::Vector2d& pixel) const;
};

}  // namespace vantage
