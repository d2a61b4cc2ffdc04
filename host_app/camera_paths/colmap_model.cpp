#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <sstream>
#include <utility>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "common/base/error.h"
#include "common/base/files/atomic_file.h"
#include "common/calibration_forms/colmap_images.h"
#include "common/image/picture_list.h"
#include "host_app/camera_paths/camera_path.h"

namespace vantage {
namespace {

constexpr std::size_t most_bytes = 1 << 28;

struct Lens {
    double field_of_view_rad;
    cv::Size size_px;
};

std::filesystem::path cameras_beside(const std::filesystem::path& images) {
    return images.parent_path() / "cameras.txt";
}

std::map<int, Lens> lenses_of(const std::string& text, const std::filesystem::path& file) {
    std::map<int, Lens> lenses;
    std::istringstream lines(text);
    std::string line;
    for (int number = 1; std::getline(lines, line); ++number) {
        if (line.find_first_not_of(" \t\r") == std::string::npos || line[0] == '#') continue;
        std::istringstream words(line);
        int id = 0;
        std::string model;
        Lens lens{};
        double f_px = 0;
        if (!(words >> id >> model >> lens.size_px.width >> lens.size_px.height >> f_px) ||
            lens.size_px.width < 1 || lens.size_px.height < 1 || !(f_px > 0))
            fail("{}:{}: this is no camera of COLMAP", file.string(), number);
        if (model != "PINHOLE" && model != "SIMPLE_PINHOLE")
            fail(
                "{}:{}: a camera of the model {} is not flown, only PINHOLE and SIMPLE_PINHOLE; "
                "COLMAP's image_undistorter makes those",
                file.string(), number, model);
        lens.field_of_view_rad = 2 * std::atan(0.5 * lens.size_px.width / f_px);
        lenses[id] = lens;
    }
    return lenses;
}

void write(const CameraPath& path, const std::filesystem::path& file) {
    if (std::filesystem::exists(cameras_beside(file)))
        fail("{} is there already: give images.txt a folder of its own",
             cameras_beside(file).string());
    // A line a lens, and the pictures that were taken with it.
    std::vector<double> angles_rad;
    std::string cameras = "# CAMERA_ID, MODEL, WIDTH, HEIGHT, PARAMS[]\n",
                images = "# IMAGE_ID, QW, QX, QY, QZ, TX, TY, TZ, CAMERA_ID, NAME\n";
    for (std::size_t i = 0; i < path.cameras.size(); ++i) {
        const CameraState& camera = path.cameras[i];
        if (angles_rad.empty() || angles_rad.back() != camera.field_of_view_rad) {
            angles_rad.push_back(camera.field_of_view_rad);
            const double f_px = camera.K(path.size_px.width, path.size_px.height)(0, 0);
            cameras += fmt::format("{} PINHOLE {} {} {:.12g} {:.12g} {} {}\n", angles_rad.size(),
                                   path.size_px.width, path.size_px.height, f_px, f_px,
                                   0.5 * path.size_px.width, 0.5 * path.size_px.height);
        }
        const Pose camera_from_world = camera.world_from_camera.inverse();
        const Eigen::Quaterniond q(camera_from_world.linear());
        const Eigen::Vector3d t = camera_from_world.translation();
        // The line of its features is empty.
        images += fmt::format(
            "{} {:.12g} {:.12g} {:.12g} {:.12g} {:.12g} {:.12g} {:.12g} {} {:06}.png\n\n", i + 1,
            q.w(), q.x(), q.y(), q.z(), t.x(), t.y(), t.z(), angles_rad.size(), i);
    }
    write_text_atomically(cameras_beside(file), cameras);
    write_text_atomically(file, images);
}

}  // namespace

CameraPath colmap_path_of(const std::string& images, const std::string& cameras,
                          const std::filesystem::path& file, const CameraPathSettings& settings) {
    const std::map<int, Lens> lenses = lenses_of(cameras, cameras_beside(file));
    CameraPath path{settings.rate_hz.value_or(default_camera_rate_hz), settings.size_px, {}};
    std::vector<std::pair<std::string, CameraState>> named;
    ColmapImages lines(images, file);
    while (const std::optional<ColmapImage> image = lines.next()) {
        const auto found = lenses.find(image->camera);
        if (found == lenses.end())
            fail("{}:{}: is of camera {}, which is not in cameras.txt beside it", file.string(),
                 image->line, image->camera);
        path.size_px = found->second.size_px;
        named.emplace_back(
            image->name,
            CameraState{
                image->camera_from_world.inverse(),
                checked_field_of_view(
                    settings.field_of_view_rad.value_or(found->second.field_of_view_rad), file),
                settings.focus_m});
    }
    require_cameras(named.size(), file);
    std::stable_sort(named.begin(), named.end(), [](const auto& a, const auto& b) {
        return is_naturally_before(a.first, b.first);
    });
    for (auto& [name, camera] : named) path.cameras.push_back(camera);
    return path;
}

CameraPathForm colmap_form() {
    return {"colmap", "images.txt, COLMAP's, with cameras.txt beside it",
            [](const std::filesystem::path& file) { return file.filename() == "images.txt"; },
            [](const std::filesystem::path& file, const CameraPathSettings& settings) {
                return colmap_path_of(read_text_file(file, most_bytes),
                                      read_text_file(cameras_beside(file), most_bytes), file,
                                      settings);
            },
            write};
}

}  // namespace vantage
