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
    // Lengths on the sensor are in 1/64 px, and in pixels in files of other programs.
    const double last_u = number("sensorMaxU"), last_v = number("sensorMaxV");
    constexpr double steps_per_px = 64, widest_px = 16384;
    const double unit = last_u > widest_px || number("focalLengthU") > widest_px ? steps_per_px : 1;
    camera.model.width_px = static_cast<int>(std::lround((last_u + 1) / unit));
    camera.model.height_px = static_cast<int>(std::lround((last_v + 1) / unit));
    camera.model.fx_px = number("focalLengthU") / unit;
    camera.model.fy_px = number("focalLengthV") / unit;
    camera.model.cx_px = number("centerPointU") / unit;
    camera.model.cy_px = number("centerPointV") / unit;
    camera.model.skew_px = number("skew") / unit;
    camera.model.distortion = usual_coefficients(
        {number("radialDistortion1"), number("radialDistortion2"), number("tangentalDistortion1"),
         number("tangentalDistortion2"), number("radialDistortion3")});
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
        if (camera.contains("@active") && xml_attribute(map, "active") == "0") {
            result.left_out.push_back(
                fmt::format("the camera '{}', which is not active", xml_attribute(map, "serial")));
            continue;
        }
        if (camera.contains("@viewrotation") && xml_number(map, "viewrotation") != 0)
            result.left_out.push_back(
                fmt::format("the rotation of the view of the camera '{}' by {} degrees: give its "
                            "pictures as the sensor stands",
                            xml_attribute(map, "serial"), xml_number(map, "viewrotation")));
        result.cameras.push_back(read_qualisys_camera(map));
    }
    return result;
}

}  // namespace

CalibrationForm qualisys_form_entry() {
    return {"qualisys", "Qualisys (.qca.txt, XML)", is_qualisys, read_qualisys};
}

}  // namespace vantage
