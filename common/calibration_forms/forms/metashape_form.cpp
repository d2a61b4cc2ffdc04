#include <cmath>
#include <map>

#include <fmt/format.h>

#include "common/calibration_forms/form_tools.h"
#include "common/calibration_forms/xml_children.h"

namespace vantage {
namespace {

bool is_metashape(const FormFile& file) {
    return file.tree.is_object() && file.tree.contains("document") &&
           file.tree["document"].is_object() && file.tree["document"].contains("chunk") &&
           !xml_children(file.tree["document"], "chunk").empty();
}

/// The lens of a sensor: f, cx and cy in pixels from the middle of the picture, Brown's
/// coefficients.
CameraModel metashape_lens(const FormMap& sensor, const FormMap& lens) {
    CameraModel camera;
    const FormMap size = lens.has("resolution") ? lens.map("resolution") : sensor.map("resolution");
    camera.width_px = whole_pixels(xml_number(size, "width"), size.where + ": 'width'");
    camera.height_px = whole_pixels(xml_number(size, "height"), size.where + ": 'height'");
    const double f_px = lens.number("f");
    camera.fx_px = f_px + lens.number("b1", 0);
    camera.fy_px = f_px;
    camera.skew_px = lens.number("b2", 0);
    // The origin is the corner of the picture, not the middle of its first pixel.
    camera.cx_px = camera.width_px / 2.0 + lens.number("cx", 0) - 0.5;
    camera.cy_px = camera.height_px / 2.0 + lens.number("cy", 0) - 0.5;
    if (lens.number("k4", 0) != 0)
        fail("{}: the coefficient k4 has no place in OpenCV's lens: calibrate without it",
             lens.where);
    // Metashape numbers the tangential coefficients the other way round than OpenCV.
    camera.distortion =
        usual_coefficients({lens.number("k1", 0), lens.number("k2", 0), lens.number("p2", 0),
                            lens.number("p1", 0), lens.number("k3", 0)});
    return camera;
}

/// The lens of a sensor; a fault in place of it where it cannot be read.
struct MetashapeSensor {
    CameraModel lens;
    std::string fault;
};

/// The adjusted calibration, else the last one, which is the initial one.
const Tree& best_calibration(const std::vector<Tree>& lenses) {
    for (const Tree& lens : lenses)
        if (lens.value("@class", "") == "adjusted") return lens;
    return lenses.back();
}

std::map<std::string, MetashapeSensor> metashape_sensors(const FormFile& file, const Tree& chunk) {
    std::map<std::string, MetashapeSensor> sensors;
    if (!chunk.contains("sensors")) return sensors;
    for (const Tree& sensor : xml_children(chunk["sensors"], "sensor")) {
        FormMap map{sensor, file.name() + ", a sensor"};
        const std::string id = xml_attribute(map, "id");
        map.where = fmt::format("{}, sensor {}", file.name(), id);
        const std::vector<Tree> lenses = xml_children(sensor, "calibration");
        if (lenses.empty()) continue;
        const FormMap lens_map{best_calibration(lenses), map.where};
        if (const std::string type = xml_attribute(lens_map, "type"); type != "frame")
            sensors[id].fault = fmt::format("whose lens is of the type '{}', not 'frame'", type);
        else
            sensors[id].lens = metashape_lens(map, lens_map);
    }
    return sensors;
}

/// Metres per unit of the chunk's frame; 0 if the chunk has no scale.
double metashape_scale(const FormFile& file, const Tree& chunk) {
    const auto scale_of = [&](const Tree& owner) {
        const FormMap map{owner, file.name()};
        return map.has("transform") && map.at("transform").is_object()
                   ? map.map("transform").number("scale", 0)
                   : 0.0;
    };
    if (const double scale = scale_of(chunk); scale > 0) return scale;
    if (chunk.contains("components"))
        for (const Tree& component : xml_children(chunk["components"], "component"))
            if (const double scale = scale_of(component); scale > 0) return scale;
    return 0;
}

FormCalibration read_metashape(std::span<const FormFile> files, const FormSettings&) {
    const FormFile& file = files.front();
    const std::vector<Tree> chunks = xml_children(file.tree["document"], "chunk");
    const Tree& chunk = chunks.front();
    FormCalibration result;
    result.assumed = {
        "principal points from the middle of the picture, pixel centres at halves, tangential "
        "coefficients in Metashape's order; cameras x right, y down, z forward"};
    result.left_out = {"the place of the cameras in the file's world"};
    const double scale = metashape_scale(file, chunk);
    if (scale > 0) {
        result.metres_per_unit = scale;
        result.unit_is_assumed = false;
        result.assumed.push_back(fmt::format("{:.6g} m per unit, the scale of the chunk", scale));
    }
    if (chunks.size() > 1) result.left_out.emplace_back("all chunks but the first");
    const std::map<std::string, MetashapeSensor> sensors = metashape_sensors(file, chunk);
    if (chunk.contains("transform") || chunk.contains("components"))
        result.left_out.emplace_back("the rotation and position of the chunk");
    if (!chunk.contains("cameras")) fail("{}: the chunk has no <cameras>", file.name());
    std::vector<Tree> cameras = xml_children(chunk["cameras"], "camera");
    for (const Tree& group : xml_children(chunk["cameras"], "group"))
        for (Tree& camera : xml_children(group, "camera")) cameras.push_back(std::move(camera));
    for (const Tree& tree : cameras) {
        FormMap map{tree, file.name() + ", a camera"};
        FormCamera camera;
        camera.name = xml_attribute(map, map.has("@label") ? "label" : "id");
        map.where = fmt::format("{}, camera '{}'", file.name(), camera.name);
        const auto leave_out = [&](const std::string& reason) {
            result.left_out.push_back(fmt::format("the camera '{}', {}", camera.name, reason));
        };
        if (!map.has("transform")) {
            leave_out(map.has("@master_id")
                          ? "whose place the file states only by the master of its rig"
                          : "which is not aligned");
            continue;
        }
        const auto sensor = sensors.find(xml_attribute(map, "sensor_id"));
        if (sensor == sensors.end())
            fail("{}: its sensor {} has no calibration in the file", map.where,
                 xml_attribute(map, "sensor_id"));
        if (!sensor->second.fault.empty()) {
            leave_out(sensor->second.fault);
            continue;
        }
        camera.model = sensor->second.lens;
        if (map.number("orientation", 1) != 1)
            result.left_out.push_back(
                fmt::format("the orientation {} of the pictures of the camera '{}': give them as "
                            "the sensor stands",
                            map.number("orientation"), camera.name));
        const std::vector<double> m = map.numbers("transform", 16);
        Eigen::Matrix3d rotation;
        rotation << m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10];
        camera.camera_from_frame =
            checked_pose(rotation, {m[3], m[7], m[11]}, map.where + ": 'transform'").inverse();
        result.cameras.push_back(std::move(camera));
    }
    return result;
}

}  // namespace

CalibrationForm metashape_form_entry() {
    return {"metashape", "Agisoft Metashape (XML)", is_metashape, read_metashape};
}

}  // namespace vantage
