#include "common/geometry/camera_model.h"

#include <array>
#include <cmath>

#include <opencv2/calib3d.hpp>

#include "common/base/error.h"
#include "common/geometry/opencv_bridge.h"

namespace vantage {

Eigen::Matrix3d CameraModel::K() const {
    Eigen::Matrix3d k;
    k << fx_px, skew_px, cx_px, 0, fy_px, cy_px, 0, 0, 1;
    return k;
}

std::vector<double> CameraModel::opencv_distortion() const {
    if (lens == LensModel::fisheye && distortion.empty()) return std::vector<double>(4, 0.0);
    return distortion;
}

void CameraModel::validate() const {
    if (width_px < 1 || height_px < 1)
        fail("camera size {}x{}: both sides must be at least 1 pixel", width_px, height_px);
    if (!(fx_px > 0) || !(fy_px > 0) || !std::isfinite(fx_px) || !std::isfinite(fy_px))
        fail("camera focal lengths {} and {} px: both must be above 0", fx_px, fy_px);
    if (!std::isfinite(cx_px) || !std::isfinite(cy_px) || !std::isfinite(skew_px))
        fail("camera centre ({}, {}) px and skew {} must be finite", cx_px, cy_px, skew_px);
    for (const double k : distortion)
        if (!std::isfinite(k)) fail("a distortion coefficient is not a finite number");
    const std::size_t n = distortion.size();
    if (lens == LensModel::fisheye && n != 0 && n != 4)
        fail("a fisheye lens has 4 distortion coefficients, and {} are given", n);
    if (lens == LensModel::pinhole && n != 0 && n != 4 && n != 5 && n != 8 && n != 12 && n != 14)
        fail("a pinhole lens has 0, 4, 5, 8, 12 or 14 distortion coefficients, and {} are given",
             n);
}

std::optional<Eigen::Vector2d> CameraModel::project(const Eigen::Vector3d& point_m) const {
    if (point_m.z() <= 0) return std::nullopt;
    Eigen::Vector2d normalised;
    if (distortion.empty() && lens == LensModel::pinhole) {
        normalised = point_m.head<2>() / point_m.z();
    } else {
        const std::vector<cv::Point3d> points = {{point_m.x(), point_m.y(), point_m.z()}};
        const cv::Vec3d none(0, 0, 0);
        std::vector<cv::Point2d> pixels;
        // Skew is applied below; OpenCV has none and gets unit intrinsics.
        if (lens == LensModel::fisheye)
            cv::fisheye::projectPoints(points, pixels, none, none, cv::Matx33d::eye(),
                                       opencv_distortion());
        else
            cv::projectPoints(points, none, none, cv::Matx33d::eye(), distortion, pixels);
        normalised = {pixels[0].x, pixels[0].y};
    }
    return Eigen::Vector2d(fx_px * normalised.x() + skew_px * normalised.y() + cx_px,
                           fy_px * normalised.y() + cy_px);
}

Eigen::Vector3d CameraModel::unproject(const Eigen::Vector2d& pixel) const {
    const double y = (pixel.y() - cy_px) / fy_px;
    const double x = (pixel.x() - cx_px - skew_px * y) / fx_px;
    if (distortion.empty() && lens == LensModel::pinhole) return {x, y, 1.0};
    const std::vector<cv::Point2d> distorted = {{x, y}};
    std::vector<cv::Point2d> ideal;
    if (lens == LensModel::fisheye)
        cv::fisheye::undistortPoints(distorted, ideal, cv::Matx33d::eye(), opencv_distortion());
    else
        cv::undistortPoints(
            distorted, ideal, cv::Matx33d::eye(), distortion, cv::noArray(), cv::noArray(),
            cv::TermCriteria(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 60, 1e-12));
    return {ideal[0].x, ideal[0].y, 1.0};
}

}  // namespace vantage
