#include <map>

#include <fmt/format.h>

#include "common/calibration_forms/form_tools.h"

namespace vantage {
namespace {

bool is_depthai(const FormFile& file) {
    return file.tree.is_object() && file.tree.contains("cameraData");
}

struct Socket {
    FormCamera camera;
    int number = 0, to = -1;
    Pose to_from_this = Pose::Identity();
};

constexpr double metres_per_centimetre = 0.01;

Socket read_socket(int number, const FormMap& map) {
    Socket socket;
    socket.number = number;
    CameraModel& model = socket.camera.model;
    model.width_px = map.pixels("width");
    model.height_px = map.pixels("height");
    set_matrix(model, map.matrix3("intrinsicMatrix"), map.where + ": 'intrinsicMatrix'");
    const bool is_fisheye =
        map.has("cameraType") && map.at("cameraType").is_number() && map.number("cameraType") == 1;
    std::vector<double> coefficients = map.numbers("distortionCoeff");
    if (is_fisheye) {
        model.lens = LensModel::fisheye;
        coefficients.resize(4, 0.0);
        model.distortion = coefficients;
    } else {
        model.distortion = usual_coefficients(std::move(coefficients));
    }
    constexpr const char* names[] = {"CAM_A (colour)", "CAM_B (left)", "CAM_C (right)", "CAM_D"};
    socket.camera.name = number >= 0 && number < 4 ? names[number] : fmt::format("{}", number);
    if (!map.has("extrinsics")) return socket;
    const FormMap pose = map.map("extrinsics");
    socket.to = static_cast<int>(pose.number("toCameraSocket", -1));
    if (socket.to < 0) return socket;
    const FormMap way = pose.map("translation");
    socket.to_from_this = checked_pose(
        pose.matrix3("rotationMatrix"),
        metres_per_centimetre * Eigen::Vector3d(way.number("x"), way.number("y"), way.number("z")),
        pose.where + ": 'rotationMatrix'");
    return socket;
}

/// The pose in the frame at the end of the camera's chain of sockets; nothing where it is broken.
std::optional<Pose> end_from_camera(const std::map<int, Socket>& sockets, const Socket& first) {
    Pose end_from_this = Pose::Identity();
    const Socket* at = &first;
    for (std::size_t steps = 0; at->to >= 0; ++steps) {
        const auto next = sockets.find(at->to);
        if (next == sockets.end() || steps > sockets.size()) return std::nullopt;
        end_from_this = at->to_from_this * end_from_this;
        at = &next->second;
    }
    return end_from_this;
}

FormCalibration read_depthai(std::span<const FormFile> files, const FormSettings&) {
    const FormMap top{files.front().tree, files.front().name()};
    std::map<int, Socket> sockets;
    for (const Tree& entry : top.at("cameraData")) {
        if (!entry.is_array() || entry.size() != 2 || !entry[0].is_number() ||
            !entry[1].is_object())
            fail("{}: 'cameraData' must be pairs of a socket and a camera", top.where);
        const int number = entry[0].get<int>();
        sockets.emplace(
            number,
            read_socket(number, {entry[1], fmt::format("{}, camera {}", top.where, number)}));
    }
    FormCalibration result;
    result.unit_is_assumed = false;
    result.assumed = {
        "pixel centres at integers, cameras x right, y down, z forward, "
        "translations in centimetres, as DepthAI defines them",
        "pictures at the size that the calibration states"};
    result.left_out = {
        "the rectification, the inertial unit and design values "
        "(specTranslation)"};
    for (const auto& [number, socket] : sockets) {
        result.cameras.push_back(socket.camera);
        if (const std::optional<Pose> end = end_from_camera(sockets, socket))
            result.cameras.back().camera_from_frame = end->inverse();
    }
    return result;
}

}  // namespace

CalibrationForm depthai_form_entry() {
    return {"depthai", "DepthAI (Luxonis)", is_depthai, read_depthai};
}

}  // namespace vantage
