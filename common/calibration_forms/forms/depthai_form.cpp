#include <algorithm>
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
    int to = -1;
    Pose to_from_this = Pose::Identity();
};

std::string socket_name(int number) {
    constexpr const char* roles[] = {" (colour)", " (left)", " (right)"};
    if (number < 0 || number > 'Z' - 'A') return fmt::format("{}", number);
    return fmt::format("CAM_{}{}", static_cast<char>('A' + number),
                       number < 3 ? roles[number] : "");
}

/// Metres per unit of a translation: centimetres, unless the file states another unit.
double socket_unit(const FormMap& extrinsics) {
    constexpr double metres[] = {1, 0.01, 0.001, 0.0254, 0.3048};
    const double unit = extrinsics.number("lengthUnit", 1);
    if (!(unit >= 0 && unit < std::size(metres)))
        fail("{}: 'lengthUnit' is {}, and is known from 0 to {}", extrinsics.where, unit,
             std::size(metres) - 1);
    return metres[static_cast<std::size_t>(unit)];
}

/// Why this camera is left out; empty if it is calibrated.
std::string socket_fault(const FormMap& map) {
    constexpr double perspective = 0, fisheye = 1;
    if (!map.has("intrinsicMatrix") || map.numbers("intrinsicMatrix").empty() ||
        map.number("width", 0) == 0)
        return "whose lens is not calibrated";
    const double type = map.number("cameraType", perspective);
    if (type != perspective && type != fisheye)
        return fmt::format("whose projection (cameraType {}) is neither pinhole nor fisheye", type);
    return {};
}

void read_socket_lens(CameraModel& model, const FormMap& map) {
    model.width_px = map.pixels("width");
    model.height_px = map.pixels("height");
    set_matrix(model, map.matrix3("intrinsicMatrix"), map.where + ": 'intrinsicMatrix'");
    if (map.has("distortionCoeff"))
        model.distortion = usual_coefficients(map.numbers("distortionCoeff"));
    if (map.number("cameraType", 0) == 0) return;
    model.lens = LensModel::fisheye;
    if (model.distortion.size() > 4)
        fail("{}: a fisheye lens has 4 distortion coefficients, and more are not 0", map.where);
    model.distortion.resize(4, 0.0);
}

/// The camera at a socket; without a lens if there is a fault.
Socket read_socket(int number, const FormMap& map, bool has_lens) {
    Socket socket;
    socket.camera.name = socket_name(number);
    if (has_lens) read_socket_lens(socket.camera.model, map);
    if (!map.has("extrinsics")) return socket;
    const FormMap pose = map.map("extrinsics");
    const double to = pose.number("toCameraSocket", -1);
    constexpr double last_socket = 1000;
    if (!(to >= 0 && to <= last_socket)) return socket;
    socket.to = static_cast<int>(to);
    const FormMap way = pose.map("translation");
    socket.to_from_this = checked_pose(
        pose.matrix3("rotationMatrix"),
        socket_unit(pose) * Eigen::Vector3d(way.number("x"), way.number("y"), way.number("z")),
        pose.where + ": 'rotationMatrix'");
    return socket;
}

/// Where a chain of sockets ends, and the pose in the frame of that end.
struct SocketChain {
    int end = 0;
    Pose end_from_camera = Pose::Identity();
};

/// Follows the chain of sockets; nothing where it runs in a circle.
std::optional<SocketChain> socket_chain(const std::map<int, Socket>& sockets, int first) {
    SocketChain chain{first};
    std::size_t steps = 0;
    for (auto at = sockets.find(first); at != sockets.end() && at->second.to >= 0;
         at = sockets.find(chain.end)) {
        if (++steps > sockets.size()) return std::nullopt;
        chain.end = at->second.to;
        chain.end_from_camera = at->second.to_from_this * chain.end_from_camera;
    }
    return chain;
}

/// Gives the cameras whose chains of sockets end at one place their poses. Of several ends the one
/// with the most cameras counts, and the others are named.
void place_sockets(FormCalibration& result, const std::map<int, Socket>& sockets,
                   const std::vector<int>& numbers) {
    std::map<int, int> cameras_at_end;
    for (const int number : numbers)
        if (const auto chain = socket_chain(sockets, number)) ++cameras_at_end[chain->end];
    const auto most =
        std::max_element(cameras_at_end.begin(), cameras_at_end.end(),
                         [](const auto& a, const auto& b) { return a.second < b.second; });
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        const std::optional<SocketChain> chain = socket_chain(sockets, numbers[i]);
        if (chain && chain->end == most->first)
            result.cameras[i].camera_from_frame = chain->end_from_camera.inverse();
        else if (numbers.size() > 1)
            result.left_out.push_back(
                fmt::format("the place of the camera '{}': no chain of sockets ties it to the "
                            "others",
                            result.cameras[i].name));
    }
}

FormCalibration read_depthai(std::span<const FormFile> files, const FormSettings&) {
    const FormMap top{files.front().tree, files.front().name()};
    FormCalibration result;
    result.unit_is_assumed = false;
    result.assumed = {
        "pixel centres at integers, cameras x right, y down, z forward, "
        "translations in centimetres unless 'lengthUnit' says another, as DepthAI defines them",
        "pictures at the size that the calibration states"};
    result.left_out = {
        "the rectification, the inertial unit and design values "
        "(specTranslation)"};
    std::map<int, Socket> sockets;
    std::vector<int> numbers;  // of the result's cameras
    for (const Tree& entry : top.at("cameraData")) {
        if (!entry.is_array() || entry.size() != 2 || !entry[0].is_number_integer() ||
            !entry[1].is_object())
            fail("{}: 'cameraData' must be pairs of a socket and a camera", top.where);
        const int number = entry[0].get<int>();
        const FormMap map{entry[1], fmt::format("{}, camera {}", top.where, number)};
        const std::string fault = socket_fault(map);
        const auto [at, is_new] = sockets.emplace(number, read_socket(number, map, fault.empty()));
        if (!is_new) fail("{} is in the file twice", map.where);
        if (!fault.empty()) {
            result.left_out.push_back(
                fmt::format("the camera '{}', {}", at->second.camera.name, fault));
            continue;
        }
        numbers.push_back(number);
        result.cameras.push_back(at->second.camera);
    }
    place_sockets(result, sockets, numbers);
    return result;
}

}  // namespace

CalibrationForm depthai_form_entry() {
    return {"depthai", "DepthAI (Luxonis)", is_depthai, read_depthai};
}

}  // namespace vantage
