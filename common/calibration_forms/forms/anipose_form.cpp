#include <fmt/format.h>

#include "common/calibration_forms/form_tools.h"

namespace vantage {
namespace {

bool is_anipose_camera(const Tree& value) {
    return value.is_object() && value.contains("matrix") && value.contains("distortions");
}

bool is_anipose(const FormFile& file) {
    if (!file.tree.is_object()) return false;
    for (const auto& [key, value] : file.tree.items())
        if (is_anipose_camera(value)) return true;
    return false;
}

FormCalibration read_anipose(std::span<const FormFile> files, const FormSettings&) {
    FormCalibration result;
    result.assumed = {"pixel centres at integers, cameras x right, y down, z forward"};
    result.left_out = {"the place of the cameras in the file's world"};
    for (const auto& [key, value] : files.front().tree.items()) {
        if (!is_anipose_camera(value)) continue;
        const FormMap map{value, files.front().name() + ", " + key};
        FormCamera camera;
        camera.name = map.has("name") ? map.text("name") : key;
        const std::vector<double> size = map.numbers("size", 2);
        camera.model.width_px = static_cast<int>(size[0]);
        camera.model.height_px = static_cast<int>(size[1]);
        set_matrix(camera.model, map.matrix3("matrix"), map.where + ": 'matrix'");
        const bool is_fisheye =
            map.has("fisheye") && map.at("fisheye").is_boolean() && map.at("fisheye").get<bool>();
        camera.model.lens = is_fisheye ? LensModel::fisheye : LensModel::pinhole;
        camera.model.distortion = is_fisheye ? map.numbers("distortions", 4)
                                             : usual_coefficients(map.numbers("distortions"));
        if (map.has("rotation") && map.has("translation")) {
            const std::vector<double> turn = map.numbers("rotation", 3),
                                      way = map.numbers("translation", 3);
            camera.camera_from_frame = checked_pose(rotation_about({turn[0], turn[1], turn[2]}),
                                                    {way[0], way[1], way[2]}, map.where);
        }
        result.cameras.push_back(std::move(camera));
    }
    return result;
}

}  // namespace

CalibrationForm anipose_form_entry() {
    return {"anipose", "anipose, caliscope or Pose2Sim (TOML)", is_anipose, read_anipose};
}

}  // namespace vantage
