#include "common/config/stage_cameras.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "common/base/error.h"
#include "common/config/intrinsics_file.h"
#include "common/config/stream_keys.h"
#include "common/config/toml_edit.h"
#include "common/config/toml_reader.h"

namespace vantage {
namespace {

constexpr int stage_file_version = 1;
constexpr double most_rotation_error = 1e-3;

/// [R | t], row by row.
using PoseNumbers = std::array<double, 12>;

Pose pose_of(const TomlTable& table, const PoseNumbers& m) {
    Pose pose = Pose::Identity();
    pose.linear() << m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10];
    pose.translation() = Eigen::Vector3d(m[3], m[7], m[11]);
    const Eigen::Matrix3d rotation = pose.linear();
    const double error =
        (rotation.transpose() * rotation - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
    if (error > most_rotation_error || rotation.determinant() < 0)
        table.refuse("world_from_camera",
                     "is not rigid: its numbers 1 to 3, 5 to 7 and 9 to 11 must be the rows of a "
                     "rotation, and 4, 8 and 12 the position in metres");
    pose.linear() = Eigen::Quaterniond(rotation).normalized().toRotationMatrix();
    return pose;
}

void read_camera(TomlTable& table, const std::filesystem::path& folder,
                 std::vector<SingleCamera>& cameras) {
    SingleCamera camera;
    read_stream_name(table, camera.name);
    for (const SingleCamera& other : cameras)
        if (other.name == camera.name)
            table.refuse("name", fmt::format("is '{}' a second time: every camera needs its own",
                                             camera.name));
    std::filesystem::path calibration;
    table.read("calibration", calibration);
    table.require("calibration");
    PoseNumbers numbers{};
    table.read("world_from_camera", std::span<double>(numbers));
    table.require("world_from_camera");
    table.read("source", camera.source);
    table.read("outline", camera.outline);
    table.finish();
    camera.model = load_intrinsics(calibration);
    camera.world_from_camera = pose_of(table, numbers);
    // A device or a camera's name is no path of a file.
    if (!camera.source.empty() && !camera.source.starts_with('/'))
        if (const auto file = folder / camera.source;
            std::filesystem::exists(file) ||
            camera.source.find_first_of(".%*?/") != std::string::npos)
            camera.source = file.lexically_normal().string();
    cameras.push_back(std::move(camera));
}

}  // namespace

std::vector<SingleCamera> load_stage_cameras(const std::filesystem::path& stage) {
    std::vector<SingleCamera> cameras;
    read_toml_file(stage, stage_file_version, [&](TomlTable& top) {
        top.leave_others();
        top.read_tables("cameras",
                        [&](TomlTable& t) { read_camera(t, stage.parent_path(), cameras); });
    });
    if (cameras.empty())
        fail(
            "{} has no [[cameras]]: name calibrated single cameras there, or let vantage-calib "
            "import --all write them",
            stage.string());
    return cameras;
}

std::string stage_camera_text(const SingleCamera& camera, const std::string& calibration_file) {
    const Eigen::Matrix4d m = camera.world_from_camera.matrix();
    std::vector<std::string> rows;
    for (int row = 0; row < 3; ++row)
        rows.push_back(fmt::format("{}, {}, {}, {}", m(row, 0), m(row, 1), m(row, 2), m(row, 3)));
    std::string text = fmt::format(
        "[[cameras]]\nname = \"{}\"\ncalibration = {}\nworld_from_camera = [{}]\n", camera.name,
        toml_string(calibration_file), fmt::join(rows, ",\n                     "));
    text += camera.source.empty() ? std::string("# source = \"film.mp4\"\n")
                                  : fmt::format("source = {}\n", toml_string(camera.source));
    text += camera.outline.empty()
                ? std::string("# outline = \"outline.png\"\n")
                : fmt::format("outline = {}\n", toml_string(camera.outline.string()));
    return text;
}

}  // namespace vantage
