#include <cmath>
#include <cstdio>
#include <map>
#include <sstream>

#include <fmt/format.h>

#include "common/base/error.h"
#include "common/base/files/atomic_file.h"
#include "common/image/image_file.h"
#include "host_app/view_sets/view_set.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t max_calibration_bytes = std::size_t{1} << 16;
constexpr int most_pictures = 9;

/// Cameras in a row: view k is k steps to the right of view 0.
struct Row {
    std::string prefix;  ///< of the image file names
    double f_px = 0, step_m = 0;
    double doffs_a_step_px = 0;
    std::map<int, int> other;  ///< per view with disparity: the view that it refers to
    double scale = 1;          ///< file value * scale = px
};

fs::path there(const fs::path& folder, const std::string& stem) {
    for (const char* extension : {".png", ".ppm", ".pgm", ".jpg"})
        if (fs::exists(folder / (stem + extension))) return folder / (stem + extension);
    return {};
}

ImportedViews write_row(const fs::path& folder, const fs::path& view_set, const Row& row) {
    ViewSetWriter writer(view_set);
    for (int k = 0; k < most_pictures; ++k) {
        const fs::path picture = there(folder, row.prefix + std::to_string(k));
        if (picture.empty()) continue;
        const ColourImage image = read_colour_image(picture);
        ViewSetWriter::Camera camera;
        camera.name = row.prefix + std::to_string(k);
        camera.K << row.f_px, 0, 0.5 * (image.cols - 1) + row.doffs_a_step_px * k,  //
            0, row.f_px, 0.5 * (image.rows - 1),                                    //
            0, 0, 1;
        camera.world_from_camera.translation().x() = row.step_m * k;
        writer.begin_view(camera, picture);
        const auto other = row.other.find(k);
        const fs::path map = there(folder, "disp" + std::to_string(k));
        if (other == row.other.end() || map.empty()) continue;
        const int steps = std::abs(other->second - k);
        writer.add_disparity({map, row.scale, 0, row.step_m * steps, row.doffs_a_step_px * steps});
    }
    if (writer.with_geometry() == 0)
        fail("{} has no disparity map of its images; use the files with ground truth",
             folder.string());
    writer.finish();
    return {writer.views(), writer.with_geometry()};
}

std::string value_of(const std::string& text, const std::string& key, const fs::path& file) {
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);)
        if (line.starts_with(key + "=")) return line.substr(key.size() + 1);
    fail("{}: the line '{}=' is missing", file.string(), key);
}

double number_of(const std::string& text, const std::string& key, const fs::path& file) {
    double value = 0;
    if (std::sscanf(value_of(text, key, file).c_str(), "%lf", &value) != 1 || !std::isfinite(value))
        fail("{}: '{}' is not a number", file.string(), key);
    return value;
}

ImportedViews import_calibrated_pair(const fs::path& folder, const fs::path& view_set) {
    const fs::path file = folder / "calib.txt";
    const std::vector<std::byte> bytes = read_file(file, max_calibration_bytes);
    const std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const double baseline_m = number_of(text, "baseline", file) / 1000;
    const double doffs_px = number_of(text, "doffs", file);
    if (!(baseline_m > 0)) fail("{}: 'baseline' must be above 0", file.string());
    ViewSetWriter writer(view_set);
    for (int k = 0; k < 2; ++k) {
        const std::string key = fmt::format("cam{}", k);
        double fx = 0, cx = 0, fy = 0, cy = 0;
        if (std::sscanf(value_of(text, key, file).c_str(), " [%lf %*f %lf; %*f %lf %lf", &fx, &cx,
                        &fy, &cy) != 4 ||
            !(fx > 0) || !(fy > 0))
            fail("{}: '{}' is not a camera matrix [f 0 cx; 0 f cy; 0 0 1]", file.string(), key);
        ViewSetWriter::Camera camera;
        camera.name = fmt::format("im{}", k);
        camera.K << fx, 0, cx, 0, fy, cy, 0, 0, 1;
        camera.world_from_camera.translation().x() = baseline_m * k;
        const fs::path picture = there(folder, camera.name);
        if (picture.empty()) fail("{} has no image {}", folder.string(), camera.name);
        writer.begin_view(camera, picture);
        for (const char* suffix : {"GT.pfm", ".pfm"}) {
            const fs::path map = folder / fmt::format("disp{}{}", k, suffix);
            if (!fs::exists(map)) continue;
            writer.add_disparity({map, {}, {}, baseline_m, doffs_px});
            break;
        }
    }
    if (writer.with_geometry() == 0)
        fail("{} has no disp0GT.pfm or disp0.pfm; use the files with ground truth",
             folder.string());
    writer.finish();
    return {writer.views(), writer.with_geometry()};
}

/// 2005 and 2006: f = 3740 px and 40 mm per step at full size, disparities in full-size pixels;
/// dmin.txt has the offset that cropping removed.
Row row_of_2006(const fs::path& folder) {
    constexpr double full_height_px = 1110;
    const double size = std::round(full_height_px / read_colour_image(there(folder, "view1")).rows);
    const std::vector<std::byte> bytes = read_file(folder / "dmin.txt", max_calibration_bytes);
    const std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    double offset_px = 0;
    if (size < 1 || std::sscanf(text.c_str(), "%lf", &offset_px) != 1)
        fail("{}: dmin.txt has no number, or the images are larger than the data set's",
             folder.string());
    return {"view", 3740 / size, 0.04, offset_px / 4 / size, {{1, 5}, {5, 1}}, 1 / size};
}

/// 2003 at its three sizes, with the cameras that the third evaluation states for Teddy; 2001 with
/// nominal ones.
Row row_of_nine(const fs::path& folder) {
    constexpr int quarter_width_px = 450;
    const int width_px = read_colour_image(there(folder, "im2")).cols;
    const int size = width_px / quarter_width_px;
    if (size >= 1 && width_px % quarter_width_px == 0)
        return {"im", 1500.0 * size, 0.02, 13.0 * size, {{2, 6}, {6, 2}}, size / 4.0};
    return {"im", static_cast<double>(width_px), 0.02, 0, {{2, 6}, {6, 2}}, 1 / 8.0};
}

}  // namespace

ImportedViews import_middlebury(const fs::path& folder, const fs::path& view_set) {
    if (fs::exists(folder / "calib.txt")) return import_calibrated_pair(folder, view_set);
    if (!there(folder, "view1").empty() && fs::exists(folder / "dmin.txt"))
        return write_row(folder, view_set, row_of_2006(folder));
    if (!there(folder, "im2").empty()) return write_row(folder, view_set, row_of_nine(folder));
    if (const fs::path left = there(folder, "im3"); !left.empty()) {
        const double f_px = read_colour_image(left).cols;
        return write_row(folder, view_set, {"im", f_px, 0.1, 0, {{3, 4}}, 1 / 16.0});
    }
    fail(
        "{} is not a Middlebury scene: it has neither calib.txt, nor view1 with dmin.txt, nor im2 "
        "or "
        "im3",
        folder.string());
}

}  // namespace vantage
