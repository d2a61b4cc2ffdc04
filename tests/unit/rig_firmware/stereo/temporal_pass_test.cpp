#include "rig_firmware/stereo/disparity/temporal_pass.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "common/gl/context/egl_context.h"
#include "common/image/image_file.h"
#include "tests/bench/stereo/filmed_pair.h"
#include "tests/references/stereo/temporal_reference.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;

class TemporalPassTest : public testing::Test {
  protected:
    DisparityImage run(TemporalPass& pass, const DisparityImage& disparity,
                       const ColourImage& picture) {
        Texture d(TextureFormat::r16ui, disparity.cols, disparity.rows);
        Texture p(TextureFormat::rgba8, picture.cols, picture.rows);
        d.upload(disparity);
        p.upload(picture);
        return pass.run(d, p).download();
    }

    EglContext context_;
    ShaderLibrary library_;
};

TEST_F(TemporalPassTest, AgreesWithItsCpuFormBitForBit) {
    cv::RNG random(9);
    TemporalPass pass(library_, 61, 47);
    TemporalReference reference;
    ColourImage picture(47, 61);
    random.fill(picture, cv::RNG::UNIFORM, 0, 256);
    DisparityImage disparity(47, 61);
    random.fill(disparity, cv::RNG::UNIFORM, 0, 3000);
    for (int frame = 0; frame < 5; ++frame) {
        for (int y = 0; y < 47; ++y)
            for (int x = 0; x < 61; ++x) {
                const int d = disparity(y, x) + random.uniform(-70, 70);
                disparity(y, x) = static_cast<unsigned short>(std::max(d, 0));
                for (int c = 0; c < 3; ++c)
                    picture(y, x)[c] = cv::saturate_cast<unsigned char>(picture(y, x)[c] +
                                                                        random.uniform(-16, 17));
            }
        const DisparityImage found = run(pass, disparity, picture);
        const DisparityImage expected = reference.run(disparity, to_grey(picture));
        for (int y = 0; y < 47; ++y)
            for (int x = 0; x < 61; ++x)
                ASSERT_EQ(found(y, x), expected(y, x)) << x << ", " << y << ", frame " << frame;
    }
}

/// What comes of one still pixel whose disparity is found to be this, frame after frame, in px.
std::vector<float> denoised_px(const std::vector<int>& found_px) {
    TemporalReference reference;
    std::vector<float> denoised;
    for (const int px : found_px) {
        const auto d = static_cast<unsigned short>(px * disparity_steps_per_px);
        const DisparityImage result = reference.run(DisparityImage(1, 1, d), GreyImage(1, 1, 90));
        denoised.push_back(static_cast<float>(result(0, 0)) / disparity_steps_per_px);
    }
    return denoised;
}

TEST(TemporalReference, HoldsAgainstWhatComesLessOftenAndGivesWayToWhatStays) {
    std::vector<int> found;
    for (int i = 0; i < 60; ++i) found.push_back(i % 3 == 2 ? 30 : 10);
    for (int i = 0; i < 40; ++i) found.push_back(30);
    const std::vector<float> denoised = denoised_px(found);
    for (std::size_t i = 0; i < 60; ++i) EXPECT_EQ(denoised[i], 10) << "frame " << i;
    EXPECT_EQ(denoised.back(), 30);
}

TEST(TemporalReference, ChangesSeldomWhereNoDisparityPrevails) {
    std::vector<int> found;
    cv::RNG random(3);
    for (int i = 0; i < 400; ++i) found.push_back(random.uniform(5, 45));
    const std::vector<float> denoised = denoised_px(found);
    int jumps = 0;
    for (std::size_t i = 1; i < denoised.size(); ++i)
        jumps += std::abs(denoised[i] - denoised[i - 1]) > 1;
    EXPECT_LE(jumps, 100) << "found ones jump nearly 400 times";
}

TEST(TemporalReference, HoldsOverALeapOfTheExposure) {
    TemporalReference reference;
    const cv::Size size(64, 48);
    cv::RNG random(6);
    GreyImage luma(size);
    random.fill(luma, cv::RNG::UNIFORM, 60, 200);
    const DisparityImage usual(size, 320), other(size, 960);
    for (int frame = 0; frame < 10; ++frame) reference.run(usual, luma);
    GreyImage brighter;
    luma.convertTo(brighter, -1, 1.1);
    EXPECT_EQ(cv::countNonZero(reference.run(other, brighter) == 320), size.area());
    EXPECT_EQ(cv::countNonZero(reference.run(other, 255 - brighter) == 960), size.area())
        << "another picture";
}

/// Sums over frames, for the variance of every pixel.
struct OverTime {
    explicit OverTime(cv::Size size) : sum(size, 0.0), squares(size, 0.0) {}

    void add(const DisparityImage& disparity) {
        cv::Mat1d px;
        disparity.convertTo(px, CV_64F, 1.0 / disparity_steps_per_px);
        sum += px;
        squares += px.mul(px);
        ++frames;
    }
    double mean(int y, int x) const { return sum(y, x) / frames; }
    double variance(int y, int x) const { return squares(y, x) / frames - mean(y, x) * mean(y, x); }

    cv::Mat1d sum, squares;
    int frames = 0;
};

TEST_F(TemporalPassTest, HalvesTheNoiseOfWhatAMatcherFindsOnAStillStageWithNoisySensors) {
    constexpr int width = 161, height = 119, warm_up = 10, frames = 20;
    VirtualStage stage(library_);
    StageFilm film(stage, {.width_px = width, .height_px = height});
    for (const MatchPreset preset :
         {MatchPreset::fast, MatchPreset::balanced, MatchPreset::quality}) {
        const auto matcher = make_matcher(
            default_matcher(preset), library_,
            {.width_px = width, .height_px = height, .disparities = 24, .preset = preset});
        TemporalPass pass(library_, width, height);
        OverTime raw({width, height}), steady({width, height});
        FilmedPair pair;
        for (int frame = 0; frame < warm_up + frames; ++frame) {
            pair = film.at(1s, {.sigma = 2}, static_cast<std::uint64_t>(frame));
            const Texture left = uploaded(pair.left), right = uploaded(pair.right);
            const Texture& found = matcher->match(left, right);
            const DisparityImage denoised = pass.run(found, left).download();
            if (frame < warm_up) continue;
            raw.add(found.download());
            steady.add(denoised);
        }
        // Over the pixels whose depth is found at all: a mismatch that jumps by pixels is no noise
        // of a measurement.
        double raw_variance = 0, variance = 0;
        int pixels = 0;
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                if (std::abs(raw.mean(y, x) - pair.disparity_px(y, x)) > 0.5 ||
                    raw.variance(y, x) > 0.25)
                    continue;
                raw_variance += raw.variance(y, x);
                variance += steady.variance(y, x);
                ++pixels;
            }
        EXPECT_GT(pixels, width * height / 2);
        EXPECT_GT(std::sqrt(raw_variance / pixels), 0.005);
        const double ratio = std::sqrt(variance / raw_variance);
        EXPECT_LE(ratio, 0.5) << default_matcher(preset);
        RecordProperty(default_matcher(preset), std::to_string(ratio));
    }
}

/// Where disparity passes halfway from the one side of an edge to the other, nearest to the edge:
/// the distance in columns, or `reach` + 1 if it does not.
int distance_of_edge(const cv::Mat1f& disparity_px, int y, int x, float halfway, bool rises,
                     int reach) {
    for (int far = 0; far <= reach; ++far)
        for (const int at : {x - far, x + far}) {
            if (at < 1 || at >= disparity_px.cols) continue;
            const float before = disparity_px(y, at - 1), after = disparity_px(y, at);
            if (rises ? before < halfway && after >= halfway : before >= halfway && after < halfway)
                return far;
        }
    return reach + 1;
}

TEST_F(TemporalPassTest, EdgesOfMovingPerformersKeepTheirPlaceWithinAPixel) {
    constexpr int width = 311, height = 239, frames = 8, reach_px = 8;
    VirtualStage stage(library_);
    StageFilm film(stage, {.width_px = width, .height_px = height});
    const auto matcher =
        make_matcher("perm", library_, {.width_px = width, .height_px = height, .disparities = 40});
    TemporalPass pass(library_, width, height);
    cv::Mat1f before;
    int moving = 0, displaced = 0;
    double raw_errors = 0, errors = 0;
    for (int frame = 0; frame < frames; ++frame) {
        const FilmedPair pair =
            film.at(1s + frame * 40ms, {.sigma = 1}, static_cast<std::uint64_t>(frame));
        const Texture left = uploaded(pair.left), right = uploaded(pair.right);
        const Texture& found = matcher->match(left, right);
        const cv::Mat1f raw = to_float_px(found.download()),
                        denoised = to_float_px(pass.run(found, left).download());
        for (int y = 0; y < height && frame > 0; ++y)
            for (int x = 41; x < width; ++x) {
                const float step = pair.disparity_px(y, x) - pair.disparity_px(y, x - 1);
                const bool has_moved =
                    std::abs(before(y, x) - before(y, x - 1)) < 2 && std::abs(step) > 4;
                if (!has_moved) continue;
                const float halfway = pair.disparity_px(y, x - 1) + step / 2;
                const int raw_at = distance_of_edge(raw, y, x, halfway, step > 0, reach_px);
                // An edge that the matcher missed tells nothing of the filter.
                if (raw_at > reach_px) continue;
                ++moving;
                raw_errors += raw_at;
                const int at = distance_of_edge(denoised, y, x, halfway, step > 0, reach_px);
                errors += at;
                displaced += at > raw_at + 1;
            }
        before = pair.disparity_px;
    }
    EXPECT_GT(moving, 500);
    EXPECT_LE(displaced, moving / 100);
    EXPECT_LE(errors / moving, raw_errors / moving + 0.05);
    RecordProperty("displaced", std::to_string(displaced) + " of " + std::to_string(moving));
    RecordProperty("mean_px",
                   std::to_string(errors / moving) + " raw " + std::to_string(raw_errors / moving));
}

TEST_F(TemporalPassTest, AMovingEdgeKeepsItsPlaceAndLeavesNoTrail) {
    constexpr int width = 96, height = 31;
    TemporalPass pass(library_, width, height);
    for (int frame = 0; frame < 12; ++frame) {
        const int edge = 20 + 4 * frame;
        ColourImage picture(height, width);
        DisparityImage disparity(height, width);
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                const bool near = x < edge && x >= edge - 16;
                const auto level = static_cast<unsigned char>(near ? 140 : 100);
                picture(y, x) = {level, level, level, 255};
                disparity(y, x) = near ? 640 : 320;
            }
        const DisparityImage denoised = run(pass, disparity, picture);
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x)
                if (std::abs(x - edge) > 1 && std::abs(x - edge + 16) > 1) {
                    ASSERT_EQ(denoised(y, x), disparity(y, x)) << x << " in frame " << frame;
                }
    }
}

}  // namespace
}  // namespace vantage
