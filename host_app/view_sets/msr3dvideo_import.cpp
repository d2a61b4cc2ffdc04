#include <algorithm>
#include <charconv>
#include <sstream>
#include <vector>

#include <Eigen/LU>
#include <Eigen/SVD>
#include <fmt/format.h>

#include "common/base/error.h"
#include "common/base/files/atomic_file.h"
#include "common/image/image_file.h"
#include "host_app/view_sets/view_set.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t max_parameter_bytes = std::size_t{1} << 20;
constexpr int max_cameras = 100, max_instants = 1000;

struct MsrCamera {
    int number = 0;
    Eigen::Matrix3d K;
    Eigen::Matrix<double, 3, 4> camera_from_world;
};

fs::path parameter_file(const fs::path& folder) {
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(folder, error))
        if (entry.path().filename().string().starts_with("calibParams") &&
            entry.path().extension() == ".txt")
            return entry.path();
    fail("{} has no calibParams-*.txt; give the folder of one sequence", folder.string());
}

/// Each camera has its number, K (9), two distortion terms and [R | t] (12).
std::vector<MsrCamera> read_cameras(const fs::path& file) {
    const std::vector<std::byte> bytes = read_file(file, max_parameter_bytes);
    std::istringstream text(std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
    std::vector<MsrCamera> cameras;
    MsrCamera camera;
    while (text >> camera.number) {
        double distortion = 0;
        for (int i = 0; i < 9; ++i) text >> camera.K(i / 3, i % 3);
        for (int i = 0; i < 2; ++i) text >> distortion;
        for (int i = 0; i < 12; ++i) text >> camera.camera_from_world(i / 4, i % 4);
        if (!text || camera.number < 0 || camera.number >= max_cameras || !(camera.K(0, 0) > 0) ||
            !(camera.K(1, 1) > 0) || camera.K.row(2) != Eigen::RowVector3d(0, 0, 1))
            fail("{}: the parameters of camera {} are truncated or invalid; download it again",
                 file.string(), camera.number);
        cameras.push_back(camera);
    }
    if (cameras.empty()) fail("{} has no camera; download it again", file.string());
    return cameras;
}

std::pair<double, double> known_depth_range(const fs::path& parameters) {
    const std::string name = parameters.filename().string();
    if (name.find("ballet") != std::string::npos) return {42, 130};
    if (name.find("breakdancers") != std::string::npos) return {44, 120};
    fail("{}: the depth range of this sequence is unknown; give it with --depth-range",
         parameters.string());
}

fs::path first_there(const fs::path& folder, const std::string& stem) {
    for (const char* extension : {".jpg", ".png"})
        if (fs::exists(folder / (stem + extension))) return folder / (stem + extension);
    return {};
}

fs::path picture_of(const fs::path& folder, int camera, int instant) {
    return first_there(folder / fmt::format("cam{}", camera),
                       fmt::format("color-cam{}-f{:03}", camera, instant));
}

fs::path depth_map_of(const fs::path& folder, int camera, int instant) {
    return folder / fmt::format("cam{0}/depth-cam{0}-f{1:03}.png", camera, instant);
}

bool has_pictures(const fs::path& folder, const std::vector<MsrCamera>& cameras, int instant) {
    return std::any_of(cameras.begin(), cameras.end(), [&](const MsrCamera& camera) {
        return !picture_of(folder, camera.number, instant).empty();
    });
}

/// Whether a camera has an image and a depth map of the instant.
bool has_depth(const fs::path& folder, const std::vector<MsrCamera>& cameras, int instant) {
    return std::any_of(cameras.begin(), cameras.end(), [&](const MsrCamera& camera) {
        return !picture_of(folder, camera.number, instant).empty() &&
               fs::exists(depth_map_of(folder, camera.number, instant));
    });
}

/// The first instant with depth, or, if there is none, with images.
std::optional<int> first_instant(const fs::path& folder, const std::vector<MsrCamera>& cameras) {
    for (const auto& is_there : {has_depth, has_pictures})
        for (int instant = 0; instant < max_instants; ++instant)
            if (is_there(folder, cameras, instant)) return instant;
    return {};
}

/// Converts to rows counted from the top, in a world with inverted y axis.
ViewSetWriter::Camera upright(const MsrCamera& camera, int height_px) {
    ViewSetWriter::Camera result;
    result.name = fmt::format("cam{}", camera.number);
    result.K << camera.K(0, 0), -camera.K(0, 1), camera.K(0, 2),  //
        0, camera.K(1, 1), height_px - 1 - camera.K(1, 2),        //
        0, 0, 1;
    const Eigen::Vector3d flip(1, -1, 1);
    const Eigen::Matrix3d rotation =
        flip.asDiagonal() * camera.camera_from_world.leftCols<3>().eval() * flip.asDiagonal();
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(rotation,
                                                Eigen::ComputeFullU | Eigen::ComputeFullV);
    Pose camera_from_world = Pose::Identity();
    camera_from_world.linear() = svd.matrixU() * svd.matrixV().transpose();
    camera_from_world.translation() = flip.asDiagonal() * camera.camera_from_world.col(3).eval();
    result.world_from_camera = camera_from_world.inverse();
    return result;
}

/// Converts codes to depth along the camera's own axis. The codes are the world's z.
DepthImage depth_of(const cv::Mat1w& codes, const ViewSetWriter::Camera& camera,
                    std::pair<double, double> range) {
    const Eigen::Matrix3d world_ray_from_pixel =
        camera.world_from_camera.linear() * camera.K.inverse();
    const double origin_z = camera.world_from_camera.translation().z();
    DepthImage depth_m(codes.size());
    for (int y = 0; y < codes.rows; ++y)
        for (int x = 0; x < codes.cols; ++x) {
            const double world_z =
                1 / (codes(y, x) / 255.0 * (1 / range.first - 1 / range.second) + 1 / range.second);
            const double z =
                (world_z - origin_z) / world_ray_from_pixel.row(2).dot(Eigen::Vector3d(x, y, 1));
            depth_m(y, x) = std::isfinite(z) && z > 0 ? static_cast<float>(z) : 0.0f;
        }
    return depth_m;
}

}  // namespace

ImportedViews import_msr3dvideo(const fs::path& folder, const fs::path& view_set,
                                std::optional<int> instant,
                                std::optional<std::pair<double, double>> depth_range) {
    const fs::path parameters = parameter_file(folder);
    const std::vector<MsrCamera> cameras = read_cameras(parameters);
    if (!instant) instant = first_instant(folder, cameras);
    if (!instant) fail("{} has no camN/color-camN-fTTT.jpg of any camera", folder.string());
    const auto range = depth_range ? *depth_range : known_depth_range(parameters);
    if (!(range.first > 0) || !(range.second > range.first))
        fail("the depth range from {} to {} is invalid; give the nearer depth, above 0, first",
             range.first, range.second);
    if (!has_pictures(folder, cameras, *instant))
        fail("{} has no image of instant {}", folder.string(), *instant);
    if (!has_depth(folder, cameras, *instant))
        fail(
            "{} has no depth map camN/depth-camN-f{:03}.png beside its images, and views cannot be "
            "rendered without depth: download the depth maps of the sequence, too",
            folder.string(), *instant);

    ViewSetWriter writer(view_set);
    for (const MsrCamera& camera : cameras) {
        const fs::path picture = picture_of(folder, camera.number, *instant);
        if (picture.empty()) continue;
        const auto view = upright(camera, read_colour_image(picture).rows);
        writer.begin_view(view, picture);
        const fs::path depth = depth_map_of(folder, camera.number, *instant);
        if (fs::exists(depth)) writer.add_depth(depth_of(read_code_image(depth), view, range));
    }
    writer.finish();
    return {writer.views(), writer.with_geometry()};
}

}  // namespace vantage
