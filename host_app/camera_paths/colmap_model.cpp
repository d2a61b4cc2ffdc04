#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <optional>
#include <sstream>
#include <string_view>
#include <utility>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "common/base/error.h"
#include "common/base/files/atomic_file.h"
#include "common/image/picture_list.h"
#include "host_app/camera_paths/camera_path_file.h"

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

struct ColmapImage {
    Pose camera_from_world;
    int camera = 0, line = 0;
    std::string name;  ///< the rest of its line: it may have spaces
};

/// The images of an images.txt. COLMAP writes two lines an image, of which the second holds the
/// points; other programs leave that line out, or empty, or end lines with CR LF.
class ColmapImages {
  public:
    ColmapImages(const std::string& text, std::filesystem::path file)
        : lines_(text), file_(std::move(file)) {}

    /// Throws Error for a line that is neither an image nor the points of the one before it.
    std::optional<ColmapImage> next() {
        while (next_line()) {
            if (line_.empty()) {
                may_be_points_ = false;
                continue;
            }
            if (line_[0] == '#') {
                note_stated_count();
                continue;
            }
            if (may_be_points_ && is_points()) {
                may_be_points_ = false;
                continue;
            }
            may_be_points_ = true;
            return image();
        }
        return std::nullopt;
    }
    /// The number of images in the header ("# Number of images: 12, ..."), if it is there.
    std::optional<std::size_t> stated_count() const { return stated_count_; }

  private:
    bool next_line() {
        if (!std::getline(lines_, line_)) return false;
        ++number_;
        line_.erase(line_.find_last_not_of(" \t\r") + 1);
        line_.erase(0, std::min(line_.find_first_not_of(" \t"), line_.size()));
        return true;
    }
    void note_stated_count() {
        constexpr std::string_view words = "# Number of images:";
        std::size_t count = 0;
        if (line_.starts_with(words) && std::istringstream(line_.substr(words.size())) >> count)
            stated_count_ = count;
    }
    /// Triples of numbers: a place in the picture and the number of a point.
    bool is_points() const {
        std::istringstream words(line_);
        std::size_t numbers = 0;
        for (std::string word; words >> word; ++numbers) {
            char* end = nullptr;
            std::strtod(word.c_str(), &end);
            if (*end != '\0') return false;
        }
        return numbers % 3 == 0;
    }
    ColmapImage image() const {
        std::istringstream words(line_);
        ColmapImage image;
        image.line = number_;
        int id = 0;
        Eigen::Quaterniond q;
        Eigen::Vector3d t;
        if (!(words >> id >> q.w() >> q.x() >> q.y() >> q.z() >> t.x() >> t.y() >> t.z() >>
              image.camera >> std::ws) ||
            !std::getline(words, image.name) || !q.coeffs().allFinite() || !t.allFinite() ||
            !(q.norm() > 0.5 && q.norm() < 2))
            fail("{}:{}: this is no image of COLMAP", file_.string(), number_);
        image.camera_from_world = Pose::Identity();
        image.camera_from_world.linear() = q.normalized().toRotationMatrix();
        image.camera_from_world.translation() = t;
        return image;
    }

    std::istringstream lines_;
    std::filesystem::path file_;
    std::string line_;
    int number_ = 0;
    bool may_be_points_ = false;  ///< the line after an image
    std::optional<std::size_t> stated_count_;
};

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
    CameraPath path{settings.rate_hz, settings.size_px, {}};
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
    if (const std::optional<std::size_t> stated = lines.stated_count();
        stated && *stated != named.size())
        fail("{} states {} images and {} could be read: the file is damaged or cut off",
             file.string(), *stated, named.size());
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
