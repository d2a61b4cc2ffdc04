#include <vector>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "tests/bench/stereo/random_scene.h"
#include "tests/bench/stereo/stereo_measures.h"

namespace vantage {
namespace {

/// Pairs of the virtual stage and of generated scenes, all with sensor noise.
std::vector<FilmedPair> noisy_pairs(const ShaderLibrary& library) {
    constexpr int width = 311, height = 239;
    std::vector<FilmedPair> pairs;
    for (const std::uint64_t set : {1, 2, 3})
        pairs.push_back(filmed_background(library, set, {width, height}, 1));
    for (const std::uint64_t seed : {4, 5}) {
        const StereoScene scene = make_random_scene(
            seed, {.width_px = width, .height_px = height, .disparities = 48}, {});
        pairs.push_back({scene.left, scene.right, scene.disparity_px});
    }
    return pairs;
}

TEST(Confidence, OrdersPixelsSoThatTheSureOnesErrFarLessThanChanceWouldHaveIt) {
    const EglContext context;
    const ShaderLibrary library;
    const std::vector<FilmedPair> pairs = noisy_pairs(library);
    for (const char* name : {"row_pairs", "perm_sgm", "perm", "coarse", "sgm"}) {
        double area = 0, by_chance = 0;
        for (const FilmedPair& pair : pairs) {
            const auto matcher = make_matcher(name, library,
                                              {.width_px = pair.left.cols,
                                               .height_px = pair.left.rows,
                                               .disparities = 48,
                                               .confidence = true});
            const std::vector<JudgedPixel> pixels =
                judged_pixels(*matcher, matched(*matcher, pair), pair, 2);
            EXPECT_LT(sparsification_area(pixels), 0.6 * bad_share(pixels)) << name;
            area += sparsification_area(pixels);
            by_chance += bad_share(pixels);
        }
        EXPECT_LT(area, 0.4 * by_chance) << name;
    }
}

TEST(Confidence, IsThereAtTheEndOfTheSearchToo) {
    const EglContext context;
    const ShaderLibrary library;
    // The last disparity of 16, and of the 8 of half the grid.
    for (const auto& [name, shift] : {std::pair("perm_sgm", 15), std::pair("coarse", 14)}) {
        cv::Mat4b wide(97, 161 + shift);
        cv::theRNG().state = 7;
        cv::randu(wide, cv::Scalar(0, 0, 0, 255), cv::Scalar(255, 255, 255, 256));
        cv::GaussianBlur(wide, wide, {}, 1.5);
        wide.convertTo(wide, -1, 4, -384);
        // What lies at x in the left picture lies at x - shift in the right one.
        const ColourImage left = wide.colRange(0, 161).clone();
        const ColourImage right = wide.colRange(shift, 161 + shift).clone();
        const auto matcher = make_matcher(
            name, library,
            {.width_px = left.cols, .height_px = left.rows, .disparities = 16, .confidence = true});
        const cv::Mat1f found = matched(*matcher, {left, right, {}});
        const cv::Mat1b confidence = matcher->confidence()->download();
        const cv::Rect middle(60, 20, 80, 60);
        EXPECT_NEAR(cv::mean(found(middle))[0], shift, 0.1) << name;
        EXPECT_GT(cv::mean(confidence(middle))[0], 60) << name;
    }
}

TEST(Confidence, SparsificationAreaIsTheBadShareOfPixelsThatAreAllAsSure) {
    EXPECT_NEAR(sparsification_area({{7, true}, {7, false}, {7, false}, {7, false}}), 0.25, 1e-12);
    EXPECT_NEAR(sparsification_area({{9, false}, {1, true}}), 0.25, 1e-12);
    EXPECT_NEAR(sparsification_area({{1, false}, {9, true}}), 0.75, 1e-12);
}

}  // namespace
}  // namespace vantage
