#include "tests/bench/stereo/stereo_stage_tables.h"

#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include "common/image/image_file.h"
#include "tests/bench/stereo/opencv_matchers.h"
#include "tests/bench/stereo/stereo_measures.h"

namespace vantage {
namespace {

constexpr int disparities = 48;
const cv::Size size_px(449, 337);
constexpr MatchPreset presets[] = {MatchPreset::quality, MatchPreset::balanced, MatchPreset::fast};

/// One set, and what everyone makes of it: HH4, then the presets.
struct BackgroundResults {
    FilmedPair pair;
    std::vector<cv::Mat1f> found_px;
    std::vector<double> area_to_chance;  ///< of the presets
};

BackgroundResults results_of(const ShaderLibrary& library, std::uint64_t set) {
    BackgroundResults results{filmed_background(library, set, size_px, 1), {}, {}};
    const FilmedPair& pair = results.pair;
    results.found_px.push_back(OpenCvMatcher(OpenCvMode::hh4, disparities)
                                   .match(to_grey(pair.left), to_grey(pair.right), true));
    for (const MatchPreset preset : presets) {
        const auto matcher = make_matcher(default_matcher(preset), library,
                                          {.width_px = size_px.width,
                                           .height_px = size_px.height,
                                           .disparities = disparities,
                                           .preset = preset,
                                           .confidence = true});
        results.found_px.push_back(matched(*matcher, pair));
        const auto pixels = judged_pixels(*matcher, results.found_px.back(), pair, 2);
        results.area_to_chance.push_back(sparsification_area(pixels) / bad_share(pixels));
    }
    return results;
}

/// Left picture, exact disparity, then everyone's.
ColourImage comparison_row(const BackgroundResults& results) {
    std::vector<cv::Mat> pictures = {results.pair.left};
    const auto add = [&](const cv::Mat1f& disparity_px) {
        pictures.push_back(colour_map_disparity(disparity_px, 0, disparities));
    };
    add(results.pair.disparity_px);
    for (const cv::Mat1f& found : results.found_px) add(found);
    cv::Mat row;
    cv::hconcat(pictures, row);
    return row;
}

}  // namespace

void print_stage_tables(const ShaderLibrary& library, const std::filesystem::path& picture) {
    fmt::print(
        "The virtual stage, {}x{}x{}, with a sensor noise of one grey level. The first columns "
        "have the sub-pixel error on slanted textured planes, RMS in px, of the pixels less than "
        "one pixel off. The last have the area under the sparsification curve of confidence, "
        "relative to chance (bad-2.0, all pixels).\n\n"
        "| scene | HH4, px | quality, px | balanced, px | fast, px | quality / chance | balanced / "
        "chance | fast / chance |\n| --- | --- | --- | --- | --- | --- | --- | --- |\n",
        size_px.width, size_px.height, disparities);
    std::vector<cv::Mat> rows;
    for (const std::uint64_t set : {0, 1, 2, 3}) {
        const BackgroundResults results = results_of(library, set);
        fmt::print("| {} |", fmt::format("stage scene {}", set));
        for (const cv::Mat1f& found : results.found_px)
            fmt::print(" {:.3f} |",
                       subpixel_error_on_slants(found, results.pair, disparities).rms_px);
        for (const double ratio : results.area_to_chance) fmt::print(" {:.2f} |", ratio);
        fmt::print("\n");
        if (set <= 1) rows.push_back(comparison_row(results));
    }
    fmt::print("\n");
    if (picture.empty()) return;
    cv::Mat both;
    cv::vconcat(rows, both);
    constexpr double shown_scale = 0.55;
    cv::resize(both, both, {}, shown_scale, shown_scale, cv::INTER_AREA);
    write_colour_image(picture, both);
}

}  // namespace vantage
