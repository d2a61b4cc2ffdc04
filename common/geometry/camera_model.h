#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

namespace vantage {

/// The lens models of OpenCV.
enum class LensModel {
    pinhole,  ///< polynomial/rational/thin-prism/tilted: 0, 4, 5, 8, 12 or 14 coefficients
    fisheye,  ///< Kannala-Brandt: 4 coefficients
};

/// One camera's intrinsics in OpenCV's conventions: x right, y down, z forward; pixel centres at
/// integer coordinates; origin at the top left. `distortion` holds the coefficients in OpenCV's
/// order.
struct CameraModel {
    int width_px = 0, height_px = 0;
    double fx_px = 0, fy_px = 0, cx_px = 0, cy_px = 0;
    double skew_px = 0;
    LensModel lens = LensModel::pinhole;
    std::vector<double> distortion;

    Eigen::Matrix3d K() const;

    /// The coefficients in the form that OpenCV's functions take: four zeros for a fisheye lens
    /// without coefficients.
    std::vector<double> opencv_distortion() const;

    /// Throws Error naming the first invalid value (size, focal length, coefficient count, not
    /// finite).
    void validate() const;

    /// Projects a point in camera coordinates to a pixel; empty at or behind the camera.
    std::optional<Eigen::Vector2d> project(const Eigen::Vector3d& point_m) const;

    /// The ray (x, y, 1) of a pixel in camera coordinates. Distortion is undone iteratively.
    Eigen::Vector3d unproject(const Eigen::Vector2d& pixel) const;
};

}  // namespace vantage
