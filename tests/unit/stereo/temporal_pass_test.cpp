#include "rig_firmware/stereo/passes/temporal_pass.h"

#include <cmath>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "common/gl/egl_context.h"
#include "common/image/image_file.h"
#include "rig_firmware/stereo/matcher.h"
#include "rig_firmware/stereo/passes/temporal_reference.h"
#include "tests/bench/random_scene.h"

namespace vantage {
namespace {

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

TEST_F(TemporalPassTest, HalvesTheNoiseOfWhatAMatcherFindsInAStillSceneWithNoisySensors) {
    const RandomSceneLook look{
        .width_px = 161, .height_px = 119, .disparities = 32, .noise_sigma = 0};
    const StereoScene scene = make_random_scene(3, look, {});
    const auto matcher =
        make_matcher("perm", library_, {.width_px = 161, .height_px = 119, .disparities = 32});
    TemporalPass pass(library_, 161, 119);
    cv::RNG random(4);
    const auto noisy = [&](const ColourImage& picture) {
        ColourImage result(picture.size());
        for (int y = 0; y < picture.rows; ++y)
            for (int x = 0; x < picture.cols; ++x)
                for (int c = 0; c < 3; ++c)
                    result(y, x)[c] =
                        cv::saturate_cast<unsigned char>(picture(y, x)[c] + random.gaussian(2));
        return result;
    };
    constexpr int warm_up = 10, frames = 20;
    cv::Mat1d raw_sum(119, 161, 0.0), raw_squares(119, 161, 0.0), sum(119, 161, 0.0),
        squares(119, 161, 0.0);
    for (int frame = 0; frame < warm_up + frames; ++frame) {
        Texture left(TextureFormat::rgba8, 161, 119), right(TextureFormat::rgba8, 161, 119);
        left.upload(noisy(scene.left));
        right.upload(noisy(scene.right));
        const Texture& found = matcher->match(left, right);
        const DisparityImage steadied = pass.run(found, left).download();
        if (frame < warm_up) continue;
        cv::Mat1d raw, steady;
        DisparityImage(found.download()).convertTo(raw, CV_64F, 1.0 / 32);
        steadied.convertTo(steady, CV_64F, 1.0 / 32);
        raw_sum += raw;
        raw_squares += raw.mul(raw);
        sum += steady;
        squares += steady.mul(steady);
    }
    // Over the pixels whose depth is found at all: a mismatch that jumps by pixels is no noise of a
    // measurement.
    double raw_variance = 0, variance = 0;
    int pixels = 0;
    for (int y = 0; y < 119; ++y)
        for (int x = 0; x < 161; ++x) {
            const auto of = [&](const cv::Mat1d& s, const cv::Mat1d& q) {
                return q(y, x) / frames - s(y, x) / frames * s(y, x) / frames;
            };
            const double mean = raw_sum(y, x) / frames;
            if (!scene.non_occluded(y, x) || std::abs(mean - scene.disparity_px(y, x)) > 0.5 ||
                of(raw_sum, raw_squares) > 0.25)
                continue;
            raw_variance += of(raw_sum, raw_squares);
            variance += of(sum, squares);
            ++pixels;
        }
    EXPECT_GT(pixels, 161 * 119 / 3);
    EXPECT_GT(std::sqrt(raw_variance / pixels), 0.005);
    EXPECT_LE(std::sqrt(variance), 0.5 * std::sqrt(raw_variance));
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
        const DisparityImage steadied = run(pass, disparity, picture);
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x)
                if (std::abs(x - edge) > 1 && std::abs(x - edge + 16) > 1) {
                    ASSERT_EQ(steadied(y, x), disparity(y, x)) << x << " in frame " << frame;
                }
    }
}

}  // namespace
}  // namespace vantage
