#include <cctype>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "common/base/error.h"
#include "common/base/files/atomic_file.h"
#include "common/base/log.h"
#include "host_app/camera_paths/camera_path.h"

namespace vantage {
namespace {

constexpr std::size_t most_bytes = 1 << 28;
constexpr double deg = 180 / std::numbers::pi;

/// OMAF's axes are x forward, y left, z up, of the world as of cameras.
Eigen::Matrix3d omaf_from_stage() {
    Eigen::Matrix3d axes;
    axes << 0, 0, -1, -1, 0, 0, 0, 1, 0;
    return axes;
}
Eigen::Matrix3d omaf_from_opencv() {
    Eigen::Matrix3d axes;
    axes << 0, 0, 1, -1, 0, 0, 0, -1, 0;
    return axes;
}

/// The axes that an MPEG view set is told in. Its poses are of cameras with the same axes as its
/// world: turned by nothing, a camera looks along the world's forward axis.
struct AxialSystem {
    Eigen::Matrix3d from_stage, from_opencv;
};

/// By its name in the file (RVS: Axial_system); OMAF where the file states none. Throws Error.
AxialSystem axial_system(const nlohmann::json& json, const std::filesystem::path& file) {
    std::string name = json.value("Axial_system", "OMAF");
    for (char& c : name) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    if (name == "OMAF") return {omaf_from_stage(), omaf_from_opencv()};
    const Eigen::Matrix3d turned_about_x = Eigen::Vector3d(1, -1, -1).asDiagonal();
    const Eigen::Matrix3d same = Eigen::Matrix3d::Identity();
    // x right, y up, z back, as the stage; or x right, y down, z forward, as OpenCV's cameras.
    const bool is_opengl = name == "OPENGL";
    if (!is_opengl && name != "OPENCV" && name != "COLMAP" && name != "VSRS")
        fail(
            "{} is in the axial system '{}', which is not known: OMAF, OPENGL, OPENCV, COLMAP and "
            "VSRS are",
            file.string(), name);
    log_info("{} is in the axial system {} and is converted to the stage's axes", file.string(),
             name);
    return is_opengl ? AxialSystem{same, turned_about_x} : AxialSystem{turned_about_x, same};
}

/// The cameras per second that the file states (TMIV: Fps), else the default. Throws Error.
double stated_rate_hz(const nlohmann::json& json, const std::filesystem::path& file) {
    if (!json.contains("Fps")) return default_camera_rate_hz;
    const double rate_hz = json.at("Fps").get<double>();
    constexpr double highest_hz = 1000;
    if (!(rate_hz > 0 && rate_hz <= highest_hz))
        fail("{}: 'Fps' is {}, and must be above 0 and at most {}", file.string(), rate_hz,
             highest_hz);
    return rate_hz;
}

/// Yaw, pitch and roll in degrees: about z, then y, then x.
Eigen::Vector3d euler_deg(const Eigen::Matrix3d& r) {
    const double pitch = std::asin(std::clamp(-r(2, 0), -1.0, 1.0));
    constexpr double least_cosine = 1e-7;
    if (std::hypot(r(0, 0), r(1, 0)) < least_cosine)
        return deg * Eigen::Vector3d(std::atan2(-r(0, 1), r(1, 1)), pitch, 0);
    return deg * Eigen::Vector3d(std::atan2(r(1, 0), r(0, 0)), pitch, std::atan2(r(2, 1), r(2, 2)));
}

Eigen::Matrix3d turned_by(const Eigen::Vector3d& euler_deg) {
    const Eigen::Vector3d angles = euler_deg / deg;
    return (Eigen::AngleAxisd(angles[0], Eigen::Vector3d::UnitZ()) *
            Eigen::AngleAxisd(angles[1], Eigen::Vector3d::UnitY()) *
            Eigen::AngleAxisd(angles[2], Eigen::Vector3d::UnitX()))
        .toRotationMatrix();
}

Eigen::Vector3d vector_of(const nlohmann::json& json, const char* key) {
    Eigen::Vector3d vector;
    for (std::size_t i = 0; i < 3; ++i)
        vector[static_cast<Eigen::Index>(i)] = json.at(key).at(i).get<double>();
    return vector;
}

void write(const CameraPath& path, const std::filesystem::path& file) {
    nlohmann::ordered_json cameras = nlohmann::ordered_json::array();
    for (std::size_t i = 0; i < path.cameras.size(); ++i)
        cameras.push_back(omaf_camera(fmt::format("p{:06}", i), path.cameras[i].world_from_camera,
                                      path.cameras[i].K(path.size_px.width, path.size_px.height),
                                      path.size_px));
    const nlohmann::ordered_json json{
        {"Version", "4.0"}, {"Fps", path.rate_hz}, {"cameras", cameras}};
    const std::string text = json.dump(1) + '\n';
    write_text_atomically(file, text);
}

}  // namespace

nlohmann::ordered_json omaf_camera(const std::string& name, const Pose& world_from_camera,
                                   const Eigen::Matrix3d& K, cv::Size size_px) {
    const auto numbers = [](const Eigen::Vector3d& v) {
        return nlohmann::ordered_json{v[0], v[1], v[2]};
    };
    constexpr double half_px = 0.5;
    return {{"Name", name},
            {"Projection", "Perspective"},
            {"Position", numbers(omaf_from_stage() * world_from_camera.translation())},
            {"Rotation", numbers(euler_deg(omaf_from_stage() * world_from_camera.linear() *
                                           omaf_from_opencv().transpose()))},
            {"Resolution", {size_px.width, size_px.height}},
            {"Focal", {K(0, 0), K(1, 1)}},
            {"Principle_point", {K(0, 2) + half_px, K(1, 2) + half_px}}};
}

CameraPath omaf_path_of(const std::string& text, const std::filesystem::path& file,
                        const CameraPathSettings& settings) {
    CameraPath path{default_camera_rate_hz, settings.size_px, {}};
    try {
        const nlohmann::json json = nlohmann::json::parse(text);
        require_cameras(json.at("cameras").size(), file);
        const AxialSystem axes = axial_system(json, file);
        path.rate_hz = settings.rate_hz ? *settings.rate_hz : stated_rate_hz(json, file);
        if (!json.value("lengthsInMeters", true))
            log_warning(
                "{} states lengths in another unit than metres, and does not say which: they are "
                "taken as metres",
                file.string());
        for (const nlohmann::json& camera : json.at("cameras")) {
            if (camera.at("Projection").get<std::string>() != "Perspective")
                fail("{}: the camera {} is {}, and only Perspective is flown", file.string(),
                     camera.at("Name").get<std::string>(),
                     camera.at("Projection").get<std::string>());
            CameraState state;
            state.world_from_camera.linear() = axes.from_stage.transpose() *
                                               turned_by(vector_of(camera, "Rotation")) *
                                               axes.from_opencv;
            state.world_from_camera.translation() =
                axes.from_stage.transpose() * vector_of(camera, "Position");
            if (!state.world_from_camera.matrix().allFinite())
                fail("{}: a camera has no place", file.string());
            path.size_px = {camera.at("Resolution").at(0).get<int>(),
                            camera.at("Resolution").at(1).get<int>()};
            if (path.size_px.width < 1 || path.size_px.height < 1)
                fail("{}: a camera's pictures have no size", file.string());
            const double f_px = camera.at("Focal").at(0).get<double>();
            state.field_of_view_rad = checked_field_of_view(
                settings.field_of_view_rad.value_or(2 * std::atan(0.5 * path.size_px.width / f_px)),
                file);
            state.focus_m = settings.focus_m;
            path.cameras.push_back(state);
        }
    } catch (const nlohmann::json::exception& error) {
        fail("{} has no cameras as an MPEG view set has them: {}", file.string(), error.what());
    }
    return path;
}

CameraPathForm omaf_form() {
    return {"omaf", "NAME.json, the cameras of an MPEG view set",
            [](const std::filesystem::path& file) { return file.extension() == ".json"; },
            [](const std::filesystem::path& file, const CameraPathSettings& settings) {
                const std::vector<std::byte> bytes = read_file(file, most_bytes);
                return omaf_path_of({reinterpret_cast<const char*>(bytes.data()), bytes.size()},
                                    file, settings);
            },
            write};
}

}  // namespace vantage
