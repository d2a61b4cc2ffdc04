#include "common/calibration_forms/colmap_images.h"

#include <algorithm>
#include <cstdlib>
#include <string_view>
#include <utility>

#include <Eigen/Geometry>

#include "common/base/error.h"

namespace vantage {

ColmapImages::ColmapImages(const std::string& text, std::filesystem::path file)
    : lines_(text), file_(std::move(file)) {}

std::optional<ColmapImage> ColmapImages::next() {
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
        ++count_;
        return image();
    }
    if (stated_count_ && *stated_count_ != count_)
        fail("{} states {} images and {} could be read: the file is damaged or cut off",
             file_.string(), *stated_count_, count_);
    return std::nullopt;
}

bool ColmapImages::next_line() {
    if (!std::getline(lines_, line_)) return false;
    ++number_;
    line_.erase(line_.find_last_not_of(" \t\r") + 1);
    line_.erase(0, std::min(line_.find_first_not_of(" \t"), line_.size()));
    return true;
}

void ColmapImages::note_stated_count() {
    constexpr std::string_view words = "# Number of images:";
    std::size_t count = 0;
    if (line_.starts_with(words) && std::istringstream(line_.substr(words.size())) >> count)
        stated_count_ = count;
}

/// Triples of numbers: a place in the picture and the number of a point.
bool ColmapImages::is_points() const {
    std::istringstream words(line_);
    std::size_t numbers = 0;
    for (std::string word; words >> word; ++numbers) {
        char* end = nullptr;
        std::strtod(word.c_str(), &end);
        if (*end != '\0') return false;
    }
    return numbers % 3 == 0;
}

ColmapImage ColmapImages::image() const {
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

}  // namespace vantage
