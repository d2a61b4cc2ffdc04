#include <cmath>

#include <fmt/format.h>

#include "common/calibration_forms/form_tools.h"

namespace vantage {
namespace {

bool is_camera_info(const FormFile& file) {
    return file.tree.is_object() && file.tree.contains("image_width") &&
           (file.tree.contains("camera_matrix") || file.tree.contains("k")) &&
           (file.tree.contains("distortion_model") || file.tree.contains("projection_matrix"));
}

struct CameraInfo {
    FormCamera camera;
    std::optional<Eigen::Matrix3d> rectification;
    /// Where the rectified frame of the camera stands from that of the first one.
    Eigen::Vector3d from_first = Eigen::Vector3d::Zero();
};

CameraInfo read_camera_info(const FormFile& file) {
    const FormMap map{file.tree, file.name()};
    CameraInfo info;
    CameraModel& model = info.camera.model;
    info.camera.name = map.has("camera_name") ? map.text("camera_name") : file.path.stem().string();
    model.width_px = map.pixels("image_width");
    model.height_px = map.pixels("image_height");
    set_matrix(model, map.matrix3("camera_matrix"), map.where + ": 'camera_matrix'");
    const std::string distortion =
        map.has("distortion_model") ? map.text("distortion_model") : "plumb_bob";
    const bool is_fisheye = distortion == "equidistant" || distortion == "fisheye";
    if (!is_fisheye && distortion != "plumb_bob" && distortion != "rational_polynomial" &&
        distortion != "none")
        fail(
            "{}: the distortion '{}' is not known to Vantage, only plumb_bob, "
            "rational_polynomial and equidistant",
            map.where, distortion);
    model.lens = is_fisheye ? LensModel::fisheye : LensModel::pinhole;
    if (map.has("distortion_coefficients"))
        model.distortion = is_fisheye ? map.numbers("distortion_coefficients", 4)
                                      : usual_coefficients(map.numbers("distortion_coefficients"));
    if (map.has("rectification_matrix"))
        info.rectification =
            checked_pose(map.matrix3("rectification_matrix"), Eigen::Vector3d::Zero(),
                         map.where + ": 'rectification_matrix'")
                .linear();
    if (map.has("projection_matrix")) {
        const std::vector<double> p = map.numbers("projection_matrix", 12);
        if (p[0] != 0 && p[5] != 0) info.from_first = {p[3] / p[0], p[7] / p[5], p[11]};
    }
    return info;
}

FormCalibration read_ros(std::span<const FormFile> files, const FormSettings&) {
    FormCalibration result;
    result.unit_is_assumed = false;
    result.assumed = {
        "pixel centres at integers, cameras x right, y down, z forward, metres, as "
        "ROS defines them"};
    for (const FormFile& file : files) {
        CameraInfo info = read_camera_info(file);
        if (info.rectification && files.size() > 1)
            info.camera.camera_from_frame = right_from_left_of(
                Eigen::Matrix3d::Identity(), *info.rectification, info.from_first);
        result.cameras.push_back(std::move(info.camera));
    }
    if (files.size() > 1)
        result.left_out = {
            "the rectification, from which the relative pose is taken; a new one is "
            "computed"};
    return result;
}

std::string matrix_text(const char* name, int rows, int columns,
                        const std::vector<double>& numbers) {
    return fmt::format("{}:\n  rows: {}\n  cols: {}\n  data: {}\n", name, rows, columns,
                       flow_list(numbers));
}

std::string camera_info_text(const char* name, const CameraModel& camera,
                             const Eigen::Matrix3d& rectification, const RectifiedStereo& r,
                             double cx_px, double shift_m) {
    const bool is_fisheye = camera.lens == LensModel::fisheye;
    require_plain_lens(camera, is_fisheye ? 4 : 8, "camera_info");
    std::vector<double> coefficients = camera.distortion;
    coefficients.resize(is_fisheye ? 4 : coefficients.size() > 5 ? 8 : 5, 0.0);
    return fmt::format("image_width: {}\nimage_height: {}\ncamera_name: {}\n", camera.width_px,
                       camera.height_px, name) +
           matrix_text("camera_matrix", 3, 3, rows_of(camera.K())) +
           fmt::format("distortion_model: {}\n", is_fisheye                ? "equidistant"
                                                 : coefficients.size() > 5 ? "rational_polynomial"
                                                                           : "plumb_bob") +
           matrix_text("distortion_coefficients", 1, static_cast<int>(coefficients.size()),
                       coefficients) +
           matrix_text("rectification_matrix", 3, 3, rows_of(rectification)) +
           matrix_text("projection_matrix", 3, 4,
                       {r.f_px, 0, cx_px, r.f_px * shift_m, 0, r.f_px, r.cy_px, 0, 0, 0, 1, 0});
}

std::vector<FormText> write_ros(const StereoCalibration& c) {
    return {{"left.yaml", camera_info_text("left", c.left, c.rectified_from_left, c.rectified,
                                           c.rectified.cx_left_px, 0)},
            {"right.yaml", camera_info_text("right", c.right, c.rectified_from_right, c.rectified,
                                            c.rectified.cx_right_px, -c.rectified.baseline_m)}};
}

}  // namespace

CalibrationForm ros_form_entry() {
    return {"ros", "ROS (camera_info)", is_camera_info, read_ros, write_ros};
}

}  // namespace vantage
