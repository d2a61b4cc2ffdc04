#include <fmt/format.h>

#include "common/calibration_forms/form_tools.h"

namespace vantage {
namespace {

constexpr const char* kalibr_name = "Kalibr";

bool is_kalibr_camera(const Tree& value) {
    return value.is_object() && value.contains("camera_model") && value.contains("intrinsics");
}

bool is_kalibr(const FormFile& file) {
    if (!file.tree.is_object()) return false;
    for (const auto& [key, value] : file.tree.items())
        if (is_kalibr_camera(value)) return true;
    return false;
}

CameraModel kalibr_lens(const FormMap& map) {
    CameraModel camera;
    if (const std::string model = map.text("camera_model"); model != "pinhole")
        fail(
            "{}: the camera model '{}' is not known to Vantage, only pinhole with the distortion "
            "radtan, equidistant or none; calibrate again with pinhole-radtan or pinhole-equi",
            map.where, model);
    const std::vector<double> size = map.numbers("resolution", 2);
    camera.width_px = static_cast<int>(size[0]);
    camera.height_px = static_cast<int>(size[1]);
    const std::vector<double> f = map.numbers("intrinsics", 4);
    camera.fx_px = f[0];
    camera.fy_px = f[1];
    camera.cx_px = f[2];
    camera.cy_px = f[3];
    const std::string distortion =
        map.has("distortion_model") ? map.text("distortion_model") : "none";
    if (distortion == "radtan" || distortion == "radial-tangential") {
        camera.distortion = map.numbers("distortion_coeffs", 4);
    } else if (distortion == "equidistant") {
        camera.lens = LensModel::fisheye;
        camera.distortion = map.numbers("distortion_coeffs", 4);
    } else if (distortion != "none") {
        fail("{}: the distortion '{}' is not known to Vantage, only radtan, equidistant and none",
             map.where, distortion);
    }
    return camera;
}

FormCalibration read_kalibr(std::span<const FormFile> files, const FormSettings&) {
    FormCalibration result;
    result.unit_is_assumed = false;
    result.assumed = {
        "pixel centres at integers, cameras x right, y down, z forward, metres, as "
        "Kalibr defines them"};
    for (const FormFile& file : files) {
        // Of the first camera, or of the inertial unit; each camera is placed from the one before.
        Pose last = Pose::Identity();
        for (const auto& [key, value] : file.tree.items()) {
            if (!is_kalibr_camera(value)) continue;
            const FormMap map{value, file.name() + ", " + key};
            FormCamera camera{key, kalibr_lens(map)};
            if (map.has("T_cn_cnm1"))
                camera.camera_from_frame = map.pose("T_cn_cnm1") * last;
            else if (map.has("T_cam_imu"))
                camera.camera_from_frame = map.pose("T_cam_imu");
            else if (map.has("T_imu_cam"))
                camera.camera_from_frame = map.pose("T_imu_cam").inverse();
            else if (result.cameras.empty())
                camera.camera_from_frame = Pose::Identity();
            if (camera.camera_from_frame) last = *camera.camera_from_frame;
            if (map.has("timeshift_cam_imu")) result.left_out = {"times of the inertial unit"};
            result.cameras.push_back(std::move(camera));
        }
    }
    return result;
}

void write_camera(std::string& text, const char* name, const CameraModel& camera) {
    const bool is_fisheye = camera.lens == LensModel::fisheye;
    require_plain_lens(camera, 4, kalibr_name);
    std::vector<double> coefficients = camera.distortion;
    coefficients.resize(4, 0.0);
    text += fmt::format(
        "{}:\n  camera_model: pinhole\n  intrinsics: {}\n  distortion_model: {}\n"
        "  distortion_coeffs: {}\n  resolution: [{}, {}]\n",
        name, flow_list({camera.fx_px, camera.fy_px, camera.cx_px, camera.cy_px}),
        is_fisheye ? "equidistant" : "radtan", flow_list(coefficients), camera.width_px,
        camera.height_px);
}

std::vector<FormText> write_kalibr(const StereoCalibration& calibration) {
    std::string text;
    write_camera(text, "cam0", calibration.left);
    write_camera(text, "cam1", calibration.right);
    text += "  T_cn_cnm1:\n";
    const std::vector<double> rows = rows_of(calibration.right_from_left);
    for (std::size_t i = 0; i < rows.size(); i += 4)
        text +=
            fmt::format("  - {}\n", flow_list({rows[i], rows[i + 1], rows[i + 2], rows[i + 3]}));
    return {{"camchain.yaml", text}};
}

}  // namespace

CalibrationForm kalibr_form_entry() {
    return {"kalibr", "Kalibr (camchain)", is_kalibr, read_kalibr, write_kalibr};
}

}  // namespace vantage
