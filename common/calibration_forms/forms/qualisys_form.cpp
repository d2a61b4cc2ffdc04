#include <cmath>

#include <fmt/format.h>

#include "common/calibration_forms/form_tools.h"
#include "common/calibration_forms/xml_children.h"

namespace vantage {
namespace {

/// The element <calibration>, which answers of the QTM server wrap in another one; null if there is
/// none.
const Tree* qualisys_calibration(const Tree& tree) {
    if (!tree.is_object() || tree.size() != 1) return nullptr;
    const Tree& root = tree.begin().value();
    const Tree* calibration = tree.contains("calibration") ? &tree["calibration"] : nullptr;
    if (!calibration && tree.begin().key().starts_with("QTM_") && root.is_object() &&
        root.contains("calibration"))
        calibration = &root["calibration"];
    if (!calibration || !calibration->is_object() || !calibration->contains("cameras"))
        return nullptr;
    const std::vector<Tree> cameras = xml_children((*calibration)["cameras"], "camera");
    const bool is_qualisys = !cameras.empty() && cameras.front().contains("intrinsic") &&
                             cameras.front()["intrinsic"].contains("@focalLengthU");
    return is_qualisys ? calibration : nullptr;
}

bool is_qualisys(const FormFile& file) { return qualisys_calibration(file.tree) != nullptr; }

FormCamera read_qualisys_camera(const FormMap& map) {
    FormCamera camera;
    camera.name = xml_attribute(map, "serial");
    const FormMap lens = map.map("intrinsic");
    const auto number = [&](const char* key) { return xml_number(lens, key); };
    const auto number_or_0 = [&](const char* key) {
        return lens.has(fmt::format("@{}", key)) ? xml_number(lens, key) : 0;
    };
    // Lengths on the sensor are in 1/64 px, and in pixels in files of other programs.
    const double last_u = number("sensorMaxU"), last_v = number("sensorMaxV");
    constexpr double steps_per_px = 64, widest_px = 16384;
    const double unit = last_u > widest_px || number("focalLengthU") > widest_px ? steps_per_px : 1;
    camera.model.width_px =
        whole_pixels(std::round((last_u + 1) / unit), map.where + ": the width of its sensor");
    camera.model.height_px =
        whole_pixels(std::round((last_v + 1) / unit), map.where + ": the height of its sensor");
    camera.model.fx_px = number("focalLengthU") / unit;
    camera.model.fy_px = number("focalLengthV") / unit;
    camera.model.cx_px = number("centerPointU") / unit;
    camera.model.cy_px = number("centerPointV") / unit;
    camera.model.skew_px = number_or_0("skew") / unit;
    camera.model.distortion =
        usual_coefficients({number("radialDistortion1"), number("radialDistortion2"),
                            number_or_0("tangentalDistortion1"),
                            number_or_0("tangentalDistortion2"), number_or_0("radialDistortion3")});
    const FormMap place = map.map("transform");
    Eigen::Matrix3d rotation;
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column)
            rotation(row, column) =
                xml_number(place, fmt::format("r{}{}", row + 1, column + 1).c_str());
    // The file's cameras have y up and look along -z.
    const Eigen::Matrix3d camera_from_world = Eigen::Vector3d(1, -1, -1).asDiagonal() * rotation;
    const Eigen::Vector3d position(xml_number(place, "x"), xml_number(place, "y"),
                                   xml_number(place, "z"));
    camera.camera_from_frame = checked_pose(camera_from_world, -(camera_from_world * position),
                                            map.where + ": 'transform'");
    return camera;
}

/// Cuts the sensor down to the field of view of its video. Returns a sentence about it, or nothing
/// if the video shows the whole sensor.
std::string crop_to_video(CameraModel& model, const FormMap& map, const std::string& name) {
    if (!map.has("fov_video")) return {};
    const FormMap view = map.map("fov_video");
    const double left = xml_number(view, "left"), top = xml_number(view, "top");
    const double right = xml_number(view, "right"), bottom = xml_number(view, "bottom");
    if (right <= left || bottom <= top) return {};  // a camera without video
    const bool is_within =
        left >= 0 && top >= 0 && right < model.width_px && bottom < model.height_px;
    if (!is_within)
        fail(
            "{}: its field of view for video, from ({}, {}) to ({}, {}), is not within its sensor "
            "of {}x{}",
            map.where, left, top, right, bottom, model.width_px, model.height_px);
    const int width_px = whole_pixels(right - left + 1, view.where);
    const int height_px = whole_pixels(bottom - top + 1, view.where);
    if (width_px == model.width_px && height_px == model.height_px) return {};
    model.width_px = width_px;
    model.height_px = height_px;
    model.cx_px -= left;
    model.cy_px -= top;
    return fmt::format("the pictures of the camera '{}' are its video of {}x{} from ({}, {})", name,
                       width_px, height_px, left, top);
}

FormCalibration read_qualisys(std::span<const FormFile> files, const FormSettings&) {
    const FormFile& file = files.front();
    FormCalibration result;
    result.metres_per_unit = 0.001;
    result.unit_is_assumed = false;
    result.assumed = {
        "pixel centres at integers; cameras y up, looking along -z, and lengths in millimetres, as "
        "Qualisys defines them; the world's axis z points up"};
    int number = 0;
    for (const Tree& camera :
         xml_children((*qualisys_calibration(file.tree))["cameras"], "camera")) {
        const FormMap map{camera, fmt::format("{}, camera {}", file.name(), ++number)};
        const auto states = [&](const char* key, const char* value) {
            return map.has(fmt::format("@{}", key)) && xml_attribute(map, key) == value;
        };
        if (states("active", "0") || states("calibrated", "false")) {
            result.left_out.push_back(fmt::format("the camera '{}', which is not {}",
                                                  xml_attribute(map, "serial"),
                                                  states("active", "0") ? "active" : "calibrated"));
            continue;
        }
        if (camera.contains("@viewrotation") && xml_number(map, "viewrotation") != 0)
            result.left_out.push_back(
                fmt::format("the rotation of the view of the camera '{}' by {} degrees: give its "
                            "pictures as the sensor stands",
                            xml_attribute(map, "serial"), xml_number(map, "viewrotation")));
        FormCamera read = read_qualisys_camera(map);
        if (std::string crop = crop_to_video(read.model, map, read.name); !crop.empty())
            result.assumed.push_back(std::move(crop));
        result.cameras.push_back(std::move(read));
    }
    return result;
}

}  // namespace

CalibrationForm qualisys_form_entry() {
    return {"qualisys", "Qualisys (.qca.txt, XML)", is_qualisys, read_qualisys};
}

}  // namespace vantage
