#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "tests/bench/random_scene.h"
#include "tests/unit/stereo/filmed_pair.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;

struct JudgedPixel {
    int confidence;
    bool is_bad;
};

/// The share of bad pixels among the most confident n, averaged over n: the area under the
/// sparsification curve (its expectation where pixels are as confident as others). Without a
/// meaning of confidence it is the share of bad pixels.
double sparsification_area(std::vector<JudgedPixel> pixels) {
    std::ranges::sort(pixels, std::greater(), &JudgedPixel::confidence);
    double area = 0, bad = 0;
    std::size_t taken = 0;
    while (taken < pixels.size()) {
        std::size_t end = taken;
        double bad_here = 0;
        while (end < pixels.size() && pixels[end].confidence == pixels[taken].confidence)
            bad_here += pixels[end++].is_bad;
        const double step = bad_here / static_cast<double>(end - taken);
        for (; taken < end; ++taken) {
            bad += step;
            area += bad / static_cast<double>(taken + 1);
        }
    }
    return area / static_cast<double>(pixels.size());
}

double bad_share(const std::vector<JudgedPixel>& pixels) {
    return static_cast<double>(std::ranges::count_if(pixels, &JudgedPixel::is_bad)) /
           static_cast<double>(pixels.size());
}

std::vector<JudgedPixel> judged(Matcher& matcher, const FilmedPair& pair, float most_px) {
    const cv::Mat1f found = matched(matcher, pair);
    const cv::Mat1b confidence = matcher.confidence()->download();
    std::vector<JudgedPixel> pixels;
    for (int y = 0; y < found.rows; ++y)
        for (int x = 0; x < found.cols; ++x)
            if (std::isfinite(pair.disparity_px(y, x)))
                pixels.push_back({confidence(y, x),
                                  !(std::abs(found(y, x) - pair.disparity_px(y, x)) <= most_px)});
    return pixels;
}

/// Pairs of the virtual stage and of generated scenes, all with sensor noise.
std::vector<FilmedPair> noisy_pairs(const ShaderLibrary& library) {
    constexpr int width = 311, height = 239;
    std::vector<FilmedPair> pairs;
    for (const std::uint64_t seed : {1, 2, 3}) {
        VirtualStage stage(library, seed);
        pairs.push_back(StageFilm(stage, {.azimuth_rad = 0.4 * static_cast<double>(seed),
                                          .width_px = width,
                                          .height_px = height})
                            .at(1s, {.sigma = 1}));
    }
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
    for (const char* name : {"perm_sgm", "perm", "coarse", "sgm"}) {
        double area = 0, by_chance = 0;
        for (const FilmedPair& pair : pairs) {
            const auto matcher = make_matcher(name, library,
                                              {.width_px = pair.left.cols,
                                               .height_px = pair.left.rows,
                                               .disparities = 48,
                                               .confidence = true});
            const std::vector<JudgedPixel> pixels = judged(*matcher, pair, 2);
            EXPECT_LT(sparsification_area(pixels), 0.6 * bad_share(pixels)) << name;
            area += sparsification_area(pixels);
            by_chance += bad_share(pixels);
        }
        EXPECT_LT(area, 0.4 * by_chance) << name;
    }
}

TEST(Confidence, SparsificationAreaIsTheBadShareOfPixelsThatAreAllAsSure) {
    EXPECT_NEAR(sparsification_area({{7, true}, {7, false}, {7, false}, {7, false}}), 0.25, 1e-12);
    EXPECT_NEAR(sparsification_area({{9, false}, {1, true}}), 0.25, 1e-12);
    EXPECT_NEAR(sparsification_area({{1, false}, {9, true}}), 0.75, 1e-12);
}

}  // namespace
}  // namespace vantage
