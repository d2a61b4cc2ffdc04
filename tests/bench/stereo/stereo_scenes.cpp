#include "tests/bench/stereo/stereo_scenes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <limits>
#include <string>

#include "common/image/image_file.h"
#include "common/image/pfm.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;
constexpr float unknown = std::numeric_limits<float>::infinity();

std::vector<fs::path> folders_in(const fs::path& parent) {
    std::vector<fs::path> folders;
    if (fs::is_directory(parent))
        for (const auto& entry : fs::directory_iterator(parent))
            if (entry.is_directory()) folders.push_back(entry.path());
    std::ranges::sort(folders);
    return folders;
}

cv::Mat1f scaled_codes(const fs::path& path, float px_per_code) {
    const cv::Mat1w codes = read_code_image(path);
    cv::Mat1f disparity(codes.size(), unknown);
    for (int y = 0; y < codes.rows; ++y)
        for (int x = 0; x < codes.cols; ++x)
            if (codes(y, x)) disparity(y, x) = static_cast<float>(codes(y, x)) * px_per_code;
    return disparity;
}

/// 255 where both cameras see the point, by the truths of both.
cv::Mat1b seen_by_both(const cv::Mat1f& left, const cv::Mat1f& right) {
    cv::Mat1b seen(left.size(), 0);
    for (int y = 0; y < left.rows; ++y)
        for (int x = 0; x < left.cols; ++x) {
            const float d = left(y, x);
            if (!std::isfinite(d)) continue;
            const int x_right = static_cast<int>(std::lround(static_cast<float>(x) - d));
            if (x_right >= 0 && std::abs(right(y, x_right) - d) <= 1) seen(y, x) = 255;
        }
    return seen;
}

/// 255 where `mask` says so and the truth is known.
cv::Mat1b judged(const cv::Mat1w& mask, const cv::Mat1f& disparity) {
    cv::Mat1b result(mask.size(), 0);
    for (int y = 0; y < mask.rows; ++y)
        for (int x = 0; x < mask.cols; ++x)
            if (mask(y, x) == 255 && std::isfinite(disparity(y, x))) result(y, x) = 255;
    return result;
}

SceneUse use_of(const std::string& name) {
    constexpr std::array tuning = {"tsukuba",     "cones",         "teddy",
                                   "books_third", "laundry_third", "moebius_third"};
    if (std::ranges::find(tuning, name) != tuning.end()) return SceneUse::tuning;
    // TeddyQ is the scene of teddy.
    return name == "aloe_half" || name == "TeddyQ" ? SceneUse::in_sight : SceneUse::held_out;
}

int disparities_of_calibration(const fs::path& path) {
    std::ifstream in(path);
    for (std::string line; std::getline(in, line);)
        if (line.starts_with("ndisp=")) return std::stoi(line.substr(6));
    return 64;
}

}  // namespace

std::vector<StereoScene> load_stereo_scenes(const fs::path& data) {
    std::vector<StereoScene> scenes;
    for (const fs::path& folder : folders_in(data / "middlebury2001")) {
        StereoScene s;
        s.name = folder.filename().string();
        s.left = read_colour_image(folder / "im3.png");
        s.right = read_colour_image(folder / "im4.png");
        s.disparity_px = scaled_codes(folder / "disp3.png", 1.0f / 16);
        s.non_occluded = judged(read_code_image(folder / "mask3_nonocc.png"), s.disparity_px);
        s.disparities = 16;
        s.use = use_of(s.name);
        scenes.push_back(std::move(s));
    }
    for (const fs::path& folder : folders_in(data / "middlebury2003")) {
        StereoScene s;
        s.name = folder.filename().string();
        s.left = read_colour_image(folder / "im2.png");
        s.right = read_colour_image(folder / "im6.png");
        s.disparity_px = scaled_codes(folder / "disp2.png", 1.0f / 4);
        s.non_occluded =
            fs::exists(folder / "mask2_nonocc.png")
                ? judged(read_code_image(folder / "mask2_nonocc.png"), s.disparity_px)
                : seen_by_both(s.disparity_px, scaled_codes(folder / "disp6.png", 1.0f / 4));
        s.use = use_of(s.name);
        scenes.push_back(std::move(s));
    }
    for (const fs::path& folder : folders_in(data / "middlebury2006")) {
        StereoScene s;
        s.name = folder.filename().string();
        s.left = read_colour_image(folder / "view1.png");
        s.right = read_colour_image(folder / "view5.png");
        // Codes are pixels of the full-size pictures.
        const float scale = s.name.ends_with("_third") ? 1.0f / 3 : 0.5f;
        s.disparity_px = scaled_codes(folder / "disp1.png", scale);
        s.non_occluded = seen_by_both(s.disparity_px, scaled_codes(folder / "disp5.png", scale));
        s.disparities = s.name.ends_with("_third") ? 80 : 107;
        s.use = use_of(s.name);
        scenes.push_back(std::move(s));
    }
    for (const fs::path& folder : folders_in(data / "middlebury_eval3")) {
        StereoScene s;
        s.name = folder.filename().string();
        s.left = read_colour_image(folder / "im0.png");
        s.right = read_colour_image(folder / "im1.png");
        s.disparity_px = read_pfm(folder / "disp0GT.pfm");
        s.non_occluded = judged(read_code_image(folder / "mask0nocc.png"), s.disparity_px);
        s.disparities = disparities_of_calibration(folder / "calib.txt");
        s.use = use_of(s.name);
        scenes.push_back(std::move(s));
    }
    return scenes;
}

std::vector<ColourImage> load_texture_photographs(const fs::path& data) {
    std::vector<fs::path> paths;
    for (const fs::path& folder : {data / "msr3dvideo", data / "rgbd"})
        if (fs::is_directory(folder))
            for (const auto& entry : fs::recursive_directory_iterator(folder)) {
                const std::string name = entry.path().filename().string();
                const bool colour = name.starts_with("color") && name.ends_with(".jpg");
                if (colour || entry.path().parent_path().filename() == "color")
                    paths.push_back(entry.path());
            }
    std::ranges::sort(paths);
    std::vector<ColourImage> photographs;
    photographs.reserve(paths.size());
    for (const fs::path& path : paths) photographs.push_back(read_colour_image(path));
    return photographs;
}

cv::Mat1b seen_by_left_only(const StereoScene& scene) {
    cv::Mat1b seen(scene.non_occluded.size(), 0);
    for (int y = 0; y < seen.rows; ++y)
        for (int x = 0; x < seen.cols; ++x)
            if (std::isfinite(scene.disparity_px(y, x)) && !scene.non_occluded(y, x))
                seen(y, x) = 255;
    return seen;
}

double bad_share(const cv::Mat1f& disparity_px, const StereoScene& scene, const cv::Mat1b& where,
                 float threshold_px) {
    long judged_pixels = 0, bad = 0;
    for (int y = 0; y < disparity_px.rows; ++y)
        for (int x = 0; x < disparity_px.cols; ++x) {
            if (!where(y, x)) continue;
            ++judged_pixels;
            const float d = disparity_px(y, x);
            if (!(d > 0) || !(std::abs(d - scene.disparity_px(y, x)) <= threshold_px)) ++bad;
        }
    return static_cast<double>(bad) / static_cast<double>(std::max(judged_pixels, 1L));
}

}  // namespace vantage
