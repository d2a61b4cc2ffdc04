#include "common/geometry/rectification_map.h"

#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "common/geometry/opencv_bridge.h"

namespace vantage {

cv::Mat2f make_undistortion_map(const CameraModel& camera, const Eigen::Matrix3d& rotation,
                                const Eigen::Matrix3d& K, cv::Size size) {
    const cv::Matx33d new_K = to_cv(K);
    // OpenCV's model has no skew: it gets unit intrinsics, and the camera matrix with skew is
    // applied to its result.
    const cv::Matx33d unit = cv::Matx33d::eye();
    cv::Mat x, y;
    if (camera.lens == LensModel::fisheye)
        cv::fisheye::initUndistortRectifyMap(
            unit, camera.distortion.empty() ? std::vector<double>(4, 0.0) : camera.distortion,
            to_cv(rotation), new_K, size, CV_32F, x, y);
    else
        cv::initUndistortRectifyMap(unit, camera.distortion, to_cv(rotation), new_K, size, CV_32F,
                                    x, y);
    cv::Mat2f positions;
    cv::merge(std::vector<cv::Mat>{x, y}, positions);
    for (auto& p : positions) {
        const double u = p[0], v = p[1];
        p[0] = static_cast<float>(camera.fx_px * u + camera.skew_px * v + camera.cx_px);
        p[1] = static_cast<float>(camera.fy_px * v + camera.cy_px);
    }
    return positions;
}

cv::Mat2f make_rectification_map(const StereoCalibration& calibration, Side side) {
    const bool is_left = side == Side::left;
    const RectifiedStereo& rectified = calibration.rectified;
    Eigen::Matrix3d K = rectified.K_left();
    if (!is_left) K(0, 2) = rectified.cx_right_px;
    return make_undistortion_map(
        is_left ? calibration.left : calibration.right,
        is_left ? calibration.rectified_from_left : calibration.rectified_from_right, K,
        {rectified.width_px, rectified.height_px});
}

bool is_identity(const StereoCalibration& calibration, Side side) {
    const bool is_left = side == Side::left;
    const CameraModel& camera = is_left ? calibration.left : calibration.right;
    const Eigen::Matrix3d& rotation =
        is_left ? calibration.rectified_from_left : calibration.rectified_from_right;
    const RectifiedStereo& r = calibration.rectified;
    for (const double k : camera.distortion)
        if (k != 0) return false;
    return camera.lens == LensModel::pinhole && rotation.isIdentity(0) && camera.skew_px == 0 &&
           camera.width_px == r.width_px && camera.height_px == r.height_px &&
           camera.fx_px == r.f_px && camera.fy_px == r.f_px && camera.cy_px == r.cy_px &&
           camera.cx_px == (is_left ? r.cx_left_px : r.cx_right_px);
}

}  // namespace vantage
