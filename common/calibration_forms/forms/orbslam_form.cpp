#include <fmt/format.h>

#include "common/calibration_forms/form_tools.h"

namespace vantage {
namespace {

bool is_orbslam(const FormFile& file) {
    if (!file.tree.is_object()) return false;
    for (const char* key : {"Camera.fx", "Camera1.fx", "Camera.type", "LEFT.K"})
        if (file.tree.contains(key)) return true;
    return false;
}

/// The camera "Camera1", "Camera2", or "Camera" of older files.
CameraModel numbered_camera(const FormMap& map, const std::string& name, const std::string& type) {
    CameraModel camera;
    camera.width_px = map.pixels("Camera.width");
    camera.height_px = map.pixels("Camera.height");
    camera.fx_px = map.number(name + ".fx");
    camera.fy_px = map.number(name + ".fy");
    camera.cx_px = map.number(name + ".cx");
    camera.cy_px = map.number(name + ".cy");
    const auto k = [&](const char* key) { return map.number(name + "." + key, 0); };
    if (type == "KannalaBrandt8") {
        camera.lens = LensModel::fisheye;
        camera.distortion = {k("k1"), k("k2"), k("k3"), k("k4")};
    } else if (type == "PinHole" || type == "Rectified") {
        camera.distortion = usual_coefficients({k("k1"), k("k2"), k("p1"), k("p2"), k("k3")});
    } else {
        fail(
            "{}: the camera type '{}' is not known to Vantage, only PinHole, Rectified and "
            "KannalaBrandt8",
            map.where, type);
    }
    return camera;
}

/// LEFT.K, LEFT.D, LEFT.R and LEFT.P, of the files before version 1 (EuRoC.yaml).
FormCamera side_camera(const FormMap& map, const std::string& side) {
    FormCamera camera{side, {}};
    CameraModel& model = camera.model;
    model.width_px = map.pixels(side + ".width");
    model.height_px = map.pixels(side + ".height");
    set_matrix(model, map.matrix3(side + ".K"), map.where + ": '" + side + ".K'");
    if (map.has(side + ".D")) model.distortion = usual_coefficients(map.numbers(side + ".D"));
    if (!map.has(side + ".R") || !map.has(side + ".P")) return camera;
    const std::vector<double> p = map.numbers(side + ".P", 12);
    const Pose turn = checked_pose(map.matrix3(side + ".R"), Eigen::Vector3d::Zero(),
                                   map.where + ": '" + side + ".R'");
    if (!(p[0] > 0)) fail("{}: '{}.P' has no focal length", map.where, side);
    camera.camera_from_frame =
        right_from_left_of(Eigen::Matrix3d::Identity(), turn.linear(), {p[3] / p[0], 0, 0});
    return camera;
}

FormCalibration read_orbslam(std::span<const FormFile> files, const FormSettings&) {
    FormCalibration result;
    result.unit_is_assumed = false;
    result.assumed = {
        "pixel centres at integers, cameras x right, y down, z forward, metres, as "
        "ORB-SLAM takes them"};
    const FormMap map{files.front().tree, files.front().name()};
    if (map.has("LEFT.K")) {
        for (const char* side : {"LEFT", "RIGHT"})
            if (map.has(std::string(side) + ".K")) result.cameras.push_back(side_camera(map, side));
        result.left_out = {
            "the rectified camera (Camera.fx and others); a new rectification is "
            "computed"};
        return result;
    }
    const std::string type = map.has("Camera.type") ? map.text("Camera.type") : "PinHole";
    const std::string first = map.has("Camera1.fx") ? "Camera1" : "Camera";
    result.cameras.push_back({first, numbered_camera(map, first, type), Pose::Identity()});
    if (type == "Rectified" || (map.has("Stereo.b") && !map.has("Camera2.fx"))) {
        FormCamera right = result.cameras.front();
        right.name = "Camera2";
        right.camera_from_frame->translation().x() = -map.number("Stereo.b");
        result.cameras.push_back(right);
        result.assumed.emplace_back("a right camera that is like the left one (Stereo.b)");
    } else if (map.has("Camera2.fx")) {
        FormCamera right{"Camera2", numbered_camera(map, "Camera2", type)};
        if (map.has("Stereo.T_c1_c2"))
            right.camera_from_frame = map.pose("Stereo.T_c1_c2").inverse();
        result.cameras.push_back(right);
    }
    result.left_out = {"settings of the tracker and of the viewer"};
    return result;
}

}  // namespace

CalibrationForm orbslam_form_entry() { return {"orbslam", "ORB-SLAM", is_orbslam, read_orbslam}; }

}  // namespace vantage
