#include <algorithm>
#include <cstring>

#include <fmt/format.h>

#include "common/calibration_forms/form_tools.h"

namespace vantage {
namespace {

bool is_anipose_camera(const Tree& value) {
    return value.is_object() && value.contains("matrix") && value.contains("distortions");
}

struct AniposeTable {
    std::string key;
    const Tree* camera;
};

/// The tables of cameras: those of the file, and of caliscope's table 'cameras', in natural order.
std::vector<AniposeTable> anipose_tables(const Tree& tree) {
    std::vector<AniposeTable> tables;
    if (!tree.is_object()) return tables;
    for (const auto& [key, value] : tree.items())
        if (is_anipose_camera(value)) tables.push_back({key, &value});
    if (tree.contains("cameras") && tree["cameras"].is_object())
        for (const auto& [key, value] : tree["cameras"].items())
            if (is_anipose_camera(value)) tables.push_back({"cam_" + key, &value});
    std::stable_sort(tables.begin(), tables.end(),
                     [](const AniposeTable& a, const AniposeTable& b) {
                         return strverscmp(a.key.c_str(), b.key.c_str()) < 0;
                     });
    return tables;
}

bool is_anipose(const FormFile& file) { return !anipose_tables(file.tree).empty(); }

/// A value that is not there; caliscope also writes the text "null" for it.
bool is_known(const FormMap& map, const char* key) {
    return map.has(key) && !(map.at(key).is_string() && map.text(key) == "null");
}

bool is_true(const FormMap& map, const char* key) {
    return map.has(key) && map.at(key).is_boolean() && map.at(key).get<bool>();
}

/// The rotation: a vector (Rodrigues), or the matrix that caliscope wrote before.
Eigen::Matrix3d anipose_rotation(const FormMap& map) {
    const std::vector<double> numbers = map.numbers("rotation");
    if (numbers.size() == 9) return matrix3_of(numbers);
    if (numbers.size() != 3)
        fail("{}: 'rotation' holds {} numbers and must have 3 or 9", map.where, numbers.size());
    return rotation_about({numbers[0], numbers[1], numbers[2]});
}

FormCamera read_anipose_camera(const std::string& name, const FormMap& map) {
    FormCamera camera;
    camera.name = name;
    const std::vector<double> size = map.numbers("size", 2);
    camera.model.width_px = whole_pixels(size[0], map.where + ": 'size'");
    camera.model.height_px = whole_pixels(size[1], map.where + ": 'size'");
    set_matrix(camera.model, map.matrix3("matrix"), map.where + ": 'matrix'");
    if (is_true(map, "fisheye")) {
        camera.model.lens = LensModel::fisheye;
        camera.model.distortion = map.numbers("distortions", 4);
    } else {
        camera.model.distortion = usual_coefficients(map.numbers("distortions"));
    }
    if (is_known(map, "rotation") && is_known(map, "translation")) {
        const std::vector<double> way = map.numbers("translation", 3);
        camera.camera_from_frame =
            checked_pose(anipose_rotation(map), {way[0], way[1], way[2]}, map.where);
    }
    return camera;
}

FormCalibration read_anipose(std::span<const FormFile> files, const FormSettings&) {
    FormCalibration result;
    result.assumed = {"pixel centres at integers, cameras x right, y down, z forward"};
    result.left_out = {"the place of the cameras in the file's world"};
    for (const AniposeTable& table : anipose_tables(files.front().tree)) {
        const FormMap map{*table.camera, files.front().name() + ", " + table.key};
        const bool has_name = map.has("name") && map.at("name").is_string();
        const std::string name = has_name ? map.text("name") : table.key;
        if (!is_known(map, "matrix") || !is_known(map, "distortions")) {
            result.left_out.push_back(
                fmt::format("the camera '{}', whose lens is not calibrated", name));
            continue;
        }
        if (is_true(map, "ignore")) {
            result.left_out.push_back(
                fmt::format("the camera '{}', which the file says to ignore", name));
            continue;
        }
        if (map.number("rotation_count", 0) != 0)
            result.left_out.push_back(
                fmt::format("the rotation of the view of the camera '{}' by {} degrees: give its "
                            "pictures as the sensor stands",
                            name, 90 * map.number("rotation_count")));
        result.cameras.push_back(read_anipose_camera(name, map));
    }
    return result;
}

}  // namespace

CalibrationForm anipose_form_entry() {
    return {"anipose", "anipose, caliscope or Pose2Sim (TOML)", is_anipose, read_anipose};
}

}  // namespace vantage
