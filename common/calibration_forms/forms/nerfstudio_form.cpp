#include <cmath>

#include <fmt/format.h>

#include "common/calibration_forms/form_tools.h"

namespace vantage {
namespace {

/// Its pixels have their centres at a half, as COLMAP's, and its cameras look along -z, y up.
constexpr double half_pixel = 0.5;

Eigen::Matrix3d opengl_from_opencv() { return Eigen::Vector3d(1, -1, -1).asDiagonal(); }

bool is_nerfstudio(const FormFile& file) {
    return file.tree.is_object() && file.tree.contains("frames") &&
           file.tree["frames"].is_array() && !file.tree["frames"].empty() &&
           file.tree["frames"].front().is_object() &&
           file.tree["frames"].front().contains("transform_matrix");
}

/// A value of the frame, or of the whole file where the frame has none.
struct FrameValues {
    FormMap frame, top;

    bool has(const char* key) const { return frame.has(key) || top.has(key); }
    const FormMap& with(const char* key) const { return frame.has(key) ? frame : top; }
    double number(const char* key) const { return with(key).number(key); }
    double number(const char* key, double otherwise) const {
        return with(key).number(key, otherwise);
    }
};

/// The focal length of one axis; nothing if the file states neither it nor the angle of view.
std::optional<double> frame_focal(const FrameValues& values, const char* key, const char* angle,
                                  int side_px) {
    if (values.has(key)) return values.number(key);
    if (!values.has(angle)) return std::nullopt;
    return 0.5 * side_px / std::tan(0.5 * values.number(angle));
}

/// The name of the lens model; instant-ngp writes a switch in place of it.
std::string frame_model(const FrameValues& values) {
    if (values.has("camera_model")) return values.with("camera_model").text("camera_model");
    const auto is_set = [&](const char* key) {
        return values.has(key) && values.with(key).at(key).is_boolean() &&
               values.with(key).at(key).get<bool>();
    };
    if (is_set("is_fisheye")) return "OPENCV_FISHEYE";
    return is_set("equirectangular") ? "EQUIRECTANGULAR" : "OPENCV";
}

CameraModel frame_lens(const FrameValues& values, const FormSettings& settings) {
    CameraModel camera;
    if (!values.has("w") && !values.has("h")) {
        if (!settings.size_px)
            fail("{}: the file has no size of the pictures: state it with --size WIDTH HEIGHT",
                 values.frame.where);
        camera.width_px = settings.size_px->width;
        camera.height_px = settings.size_px->height;
    } else {
        camera.width_px = values.with("w").pixels("w");
        camera.height_px = values.with("h").pixels("h");
    }
    const auto fx = frame_focal(values, "fl_x", "camera_angle_x", camera.width_px);
    const auto fy = frame_focal(values, "fl_y", "camera_angle_y", camera.height_px);
    if (!fx && !fy)
        fail("{}: there is no focal length: 'fl_x' and 'camera_angle_x' are missing",
             values.frame.where);
    camera.fx_px = fx ? *fx : *fy;
    camera.fy_px = fy ? *fy : *fx;
    camera.cx_px = values.number("cx", 0.5 * camera.width_px) - half_pixel;
    camera.cy_px = values.number("cy", 0.5 * camera.height_px) - half_pixel;
    const std::string model = frame_model(values);
    const auto k = [&](const char* key) { return values.number(key, 0); };
    if (model == "OPENCV_FISHEYE" || model == "FISHEYE") {
        camera.lens = LensModel::fisheye;
        camera.distortion = {k("k1"), k("k2"), k("k3"), k("k4")};
    } else if (model == "OPENCV" || model == "PERSPECTIVE" || model == "PINHOLE" ||
               model == "SIMPLE_PINHOLE" || model == "RADIAL" || model == "SIMPLE_RADIAL") {
        if (k("k4") != 0)
            fail("{}: its fourth radial coefficient is no coefficient of OpenCV's pinhole model",
                 values.frame.where);
        camera.distortion = usual_coefficients({k("k1"), k("k2"), k("p1"), k("p2"), k("k3")});
    } else {
        fail(
            "{}: the camera model '{}' is not known to Vantage, only OPENCV, PINHOLE, RADIAL and "
            "OPENCV_FISHEYE",
            values.frame.where, model);
    }
    return camera;
}

FormCalibration read_nerfstudio(std::span<const FormFile> files, const FormSettings& settings) {
    const FormMap top{files.front().tree, files.front().name()};
    FormCalibration result;
    result.assumed = {"pixel centres at a half, moved to integers",
                      "cameras x right, y up, z back (OpenGL), turned to x right, y down, z "
                      "forward"};
    result.left_out = {"the place of the cameras in the file's world"};
    for (const Tree& entry : top.at("frames")) {
        const FormMap frame{entry,
                            fmt::format("{}, frame {}", top.where, result.cameras.size() + 1)};
        if (!entry.is_object()) fail("{} must be a map", frame.where);
        FormCamera camera;
        camera.name = frame.has("file_path") ? frame.text("file_path")
                                             : fmt::format("{}", result.cameras.size() + 1);
        camera.model = frame_lens({frame, top}, settings);
        Pose world_from_camera = frame.pose("transform_matrix");
        world_from_camera.linear() = world_from_camera.linear() * opengl_from_opencv();
        camera.camera_from_frame = world_from_camera.inverse();
        result.cameras.push_back(std::move(camera));
    }
    return result;
}

Tree frame_tree(const CameraModel& camera, const Pose& world_from_camera, const char* name) {
    const bool is_fisheye = camera.lens == LensModel::fisheye;
    require_plain_lens(camera, is_fisheye ? 4 : 5, "nerfstudio");
    Pose pose = world_from_camera;
    pose.linear() = world_from_camera.linear() * opengl_from_opencv();
    Tree rows = Tree::array();
    for (int row = 0; row < 4; ++row)
        rows.push_back({pose.matrix()(row, 0), pose.matrix()(row, 1), pose.matrix()(row, 2),
                        pose.matrix()(row, 3)});
    Tree frame{{"file_path", name},
               {"w", camera.width_px},
               {"h", camera.height_px},
               {"fl_x", camera.fx_px},
               {"fl_y", camera.fy_px},
               {"cx", camera.cx_px + half_pixel},
               {"cy", camera.cy_px + half_pixel},
               {"camera_model", is_fisheye ? "OPENCV_FISHEYE" : "OPENCV"},
               {"k1", coefficient(camera, 0)},
               {"k2", coefficient(camera, 1)},
               {"transform_matrix", rows}};
    if (is_fisheye) {
        frame["k3"] = coefficient(camera, 2);
        frame["k4"] = coefficient(camera, 3);
    } else {
        frame["p1"] = coefficient(camera, 2);
        frame["p2"] = coefficient(camera, 3);
        frame["k3"] = coefficient(camera, 4);
    }
    return frame;
}

std::vector<FormText> write_nerfstudio(const StereoCalibration& c) {
    const Pose world_from_right = c.world_from_left * c.right_from_left.inverse();
    const Tree tree{{"frames",
                     {frame_tree(c.left, c.world_from_left, "left.png"),
                      frame_tree(c.right, world_from_right, "right.png")}}};
    return {{"transforms.json", tree.dump(1) + "\n"}};
}

}  // namespace

CalibrationForm nerfstudio_form_entry() {
    return {"nerfstudio", "nerfstudio (transforms.json)", is_nerfstudio, read_nerfstudio,
            write_nerfstudio};
}

}  // namespace vantage
