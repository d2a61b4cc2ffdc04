#include "common/geometry/stereo_calibration.h"

#include <cmath>

#include <opencv2/calib3d.hpp>

#include "common/base/error.h"
#include "common/geometry/opencv_bridge.h"

namespace vantage {
namespace {

void require_rotation(const Eigen::Matrix3d& r, const char* name) {
    if (!r.allFinite() || (r * r.transpose() - Eigen::Matrix3d::Identity()).norm() > 1e-6 ||
        r.determinant() < 0)
        fail("{} is not a rotation matrix", name);
}

cv::Matx33d cv_K(const CameraModel& camera) { return to_cv(camera.K()); }

}  // namespace

Pose StereoCalibration::world_from_rectified_left() const {
    Pose left_from_rectified = Pose::Identity();
    left_from_rectified.linear() = rectified_from_left.transpose();
    return world_from_left * left_from_rectified;
}

void StereoCalibration::validate() const {
    left.validate();
    right.validate();
    require_rotation(right_from_left.linear(), "right_from_left");
    require_rotation(rectified_from_left, "rectified_from_left");
    require_rotation(rectified_from_right, "rectified_from_right");
    require_rotation(world_from_left.linear(), "world_from_left");
    if (!right_from_left.translation().allFinite() || !world_from_left.translation().allFinite())
        fail("a translation of the calibration is not finite");
    if (rectified.width_px < 1 || rectified.height_px < 1)
        fail("rectified size {}x{}: both sides must be at least 1 pixel", rectified.width_px,
             rectified.height_px);
    if (!(rectified.f_px > 0) || !std::isfinite(rectified.f_px))
        fail("rectified focal length {} px must be above 0", rectified.f_px);
    if (!(rectified.baseline_m > 0) || !std::isfinite(rectified.baseline_m))
        fail("baseline {} m must be above 0 (are left and right swapped?)", rectified.baseline_m);
    if (!std::isfinite(rectified.cx_left_px) || !std::isfinite(rectified.cx_right_px) ||
        !std::isfinite(rectified.cy_px))
        fail("the rectified principal points must be finite");
}

void compute_rectification(StereoCalibration& c, double alpha) {
    c.left.validate();
    c.right.validate();
    if (c.left.lens != c.right.lens)
        fail("one lens is fisheye and the other is not: a pair needs lenses of one model");
    const cv::Size raw(c.left.width_px, c.left.height_px);
    const cv::Size size(c.rectified.width_px > 0 ? c.rectified.width_px : raw.width,
                        c.rectified.height_px > 0 ? c.rectified.height_px : raw.height);
    cv::Matx33d r1, r2;
    cv::Matx34d p1, p2;
    cv::Mat q;
    const cv::Matx33d rotation = to_cv(Eigen::Matrix3d(c.right_from_left.linear()));
    const cv::Vec3d translation = to_cv(Eigen::Vector3d(c.right_from_left.translation()));
    if (c.left.lens == LensModel::fisheye) {
        cv::fisheye::stereoRectify(cv_K(c.left), c.left.opencv_distortion(), cv_K(c.right),
                                   c.right.opencv_distortion(), raw, rotation, translation, r1, r2,
                                   p1, p2, q, cv::CALIB_ZERO_DISPARITY, size, alpha);
    } else {
        cv::stereoRectify(cv_K(c.left), c.left.distortion, cv_K(c.right), c.right.distortion, raw,
                          rotation, translation, r1, r2, p1, p2, q, cv::CALIB_ZERO_DISPARITY, alpha,
                          size);
    }
    c.rectified_from_left = to_eigen(r1);
    c.rectified_from_right = to_eigen(r2);
    c.rectified.width_px = size.width;
    c.rectified.height_px = size.height;
    c.rectified.f_px = p1(0, 0);
    c.rectified.cx_left_px = p1(0, 2);
    c.rectified.cx_right_px = p2(0, 2);
    c.rectified.cy_px = p1(1, 2);
    c.rectified.baseline_m = -p2(0, 3) / p2(0, 0);
    if (!(c.rectified.baseline_m > 0))
        fail(
            "the right camera stands left of or above the left one (baseline {:.4f} m along x): "
            "swap left and right, or turn the rig's cameras side by side",
            c.rectified.baseline_m);
}

void assume_place(StereoCalibration& c) {
    const Eigen::Vector3d middle_m(0, assumed_height_m, 0);
    Pose world_from_rectified = look_at(middle_m, middle_m - Eigen::Vector3d::UnitZ());
    world_from_rectified.translation().x() -= 0.5 * c.rectified.baseline_m;
    c.world_from_left = world_from_rectified;
    c.world_from_left.linear() *= c.rectified_from_left;
    c.place_is_assumed = true;
}

StereoCalibration rectified_calibration(const RectifiedStereo& geometry) {
    StereoCalibration c;
    c.left.width_px = c.right.width_px = geometry.width_px;
    c.left.height_px = c.right.height_px = geometry.height_px;
    c.left.fx_px = c.left.fy_px = c.right.fx_px = c.right.fy_px = geometry.f_px;
    c.left.cx_px = geometry.cx_left_px;
    c.right.cx_px = geometry.cx_right_px;
    c.left.cy_px = c.right.cy_px = geometry.cy_px;
    c.right_from_left.translation() = Eigen::Vector3d(-geometry.baseline_m, 0, 0);
    c.rectified = geometry;
    return c;
}

}  // namespace vantage
