#include "tests/bench/stereo/plain_surface_table.h"

#include <array>
#include <iostream>
#include <string>

#include <fmt/format.h>

#include "common/image/image_file.h"
#include "tests/bench/stereo/opencv_matchers.h"
#include "tests/bench/stereo/stereo_measures.h"
#include "tests/bench/stereo/stereo_scenes.h"

namespace vantage {
namespace {

constexpr std::array presets = {MatchPreset::quality, MatchPreset::balanced, MatchPreset::fast};
constexpr std::size_t columns = 1 + presets.size();  ///< HH4 and the presets
constexpr float threshold_px = 2;
constexpr std::uint64_t stage_frame_sets = 7;

/// Plain pixels that both cameras see, and those of them that are off, a column each.
struct Count {
    std::array<double, columns> bad{};
    double judged = 0, all = 0;

    void add(const Count& other) {
        for (std::size_t i = 0; i < columns; ++i) bad[i] += other.bad[i];
        judged += other.judged;
        all += other.all;
    }
    void print(const std::string& name) const {
        fmt::print("| {} | {:.0f} |", name, 100 * judged / std::max(all, 1.0));
        for (const double b : bad) fmt::print(" {:.2f} |", 100 * b / std::max(judged, 1.0));
        fmt::print("\n");
        std::cout.flush();
    }
};

Count count_of(const ShaderLibrary& library, const StereoScene& scene) {
    const GreyImage left = to_grey(scene.left), right = to_grey(scene.right);
    const cv::Mat1b plain = plain_pixels(left) & scene.non_occluded;
    Count count;
    count.judged = cv::countNonZero(plain);
    count.all = cv::countNonZero(scene.non_occluded);
    const auto judge = [&](const cv::Mat1f& found_px) {
        return bad_share(found_px, scene, plain, threshold_px) * count.judged;
    };
    count.bad[0] =
        judge(OpenCvMatcher(OpenCvMode::hh4, scene.disparities).match(left, right, true));
    const FilmedPair pair{scene.left, scene.right, scene.disparity_px};
    for (std::size_t i = 0; i < presets.size(); ++i) {
        const auto matcher = make_matcher(default_matcher(presets[i]), library,
                                          {.width_px = left.cols,
                                           .height_px = left.rows,
                                           .disparities = scene.disparities,
                                           .preset = presets[i]});
        count.bad[i + 1] = judge(matched(*matcher, pair));
    }
    return count;
}

StereoScene scene_of_set(const ShaderLibrary& library, std::uint64_t set) {
    const FilmedPair pair = filmed_background(library, set, {449, 337}, 1);
    StereoScene scene;
    scene.name = fmt::format("stage scene {}", set);
    scene.left = pair.left;
    scene.right = pair.right;
    scene.disparity_px = pair.disparity_px;
    scene.disparities = 48;
    scene.non_occluded =
        seen_by_right(pair.disparity_px) & (pair.disparity_px < scene.disparities - 1);
    return scene;
}

}  // namespace

void print_plain_surface_table(const ShaderLibrary& library,
                               const std::vector<StereoScene>& scenes) {
    fmt::print(
        "Plain surfaces: bad-2.0 in per cent where the gradient's mean over 9x9 pixels is below {} "
        "grey levels per pixel. Only pixels that both cameras see count; the column *plain* has "
        "their share.\n\n"
        "| scene | plain, % | HH4 | quality | balanced | fast |\n"
        "| --- | --- | --- | --- | --- | --- |\n",
        most_plain_gradient);
    Count photographs, generated, sets;
    for (const StereoScene& scene : scenes) {
        const Count count = count_of(library, scene);
        const bool is_generated = scene.name.starts_with("generated");
        (is_generated ? generated : photographs).add(count);
        if (!is_generated) count.print(scene.name);
    }
    for (std::uint64_t set = 0; set < stage_frame_sets; ++set) {
        const StereoScene scene = scene_of_set(library, set);
        const Count count = count_of(library, scene);
        count.print(scene.name);
        sets.add(count);
    }
    photographs.print("**photographs, all pixels**");
    sets.print("**the stage's scenes, all pixels**");
    generated.print("**generated scenes, all pixels**");
    fmt::print("\n");
}

}  // namespace vantage
