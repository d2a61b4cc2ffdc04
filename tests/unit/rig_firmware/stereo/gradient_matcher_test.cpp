#include <algorithm>

#include <gtest/gtest.h>

#include "common/image/image_file.h"
#include "rig_firmware/stereo/matcher.h"
#include "tests/references/thesis/gradient_reference.h"
#include "tests/support/data_folder.h"
#include "tests/support/thrown_sentence.h"
#include "tests/unit/rig_firmware/stereo/thesis_buffers.h"

namespace vantage {
namespace {

Texture upload(const ColourImage& picture) {
    Texture texture(TextureFormat::rgba8, picture.cols, picture.rows);
    texture.upload(picture);
    return texture;
}

MatchSettings settings_of(const ColourImage& picture, int disparities, MatchPreset preset,
                          bool fill) {
    return {.width_px = picture.cols,
            .height_px = picture.rows,
            .disparities = disparities,
            .preset = preset,
            .fill = fill};
}

class GradientMatcherTest : public testing::Test {
  protected:
    DisparityImage match(const ColourImage& left, const ColourImage& right, int disparities,
                         MatchPreset preset, bool fill) {
        const auto matcher =
            make_matcher("gradient", library_, settings_of(left, disparities, preset, fill));
        return matcher->match(upload(left), upload(right)).download();
    }
    EglContext context_;
    ShaderLibrary library_;
};

TEST_F(GradientMatcherTest, EqualsItsReferenceInEveryPreset) {
    const ColourImage left = thesis::blobs(61, 47, 20), right = thesis::blobs(61, 47, 21);
    for (const MatchPreset preset :
         {MatchPreset::fast, MatchPreset::balanced, MatchPreset::quality})
        for (const bool fill : {true, false})
            EXPECT_EQ(cv::norm(match(left, right, 13, preset, fill),
                               thesis::gradient_reference(left, right, 13,
                                                          thesis::settings_for(preset), fill),
                               cv::NORM_INF),
                      0);
}

TEST_F(GradientMatcherTest, EqualsItsReferenceWhenTheSearchIsCutIntoBatches) {
    // At this size a batch holds 48 of the disparities.
    const ColourImage left = thesis::blobs(311, 239, 22), right = thesis::blobs(311, 239, 23);
    EXPECT_EQ(cv::norm(match(left, right, 67, MatchPreset::fast, true),
                       thesis::gradient_reference(left, right, 67,
                                                  thesis::settings_for(MatchPreset::fast), true),
                       cv::NORM_INF),
              0);
}

TEST_F(GradientMatcherTest, FindsTheShiftOfATexturedPlane) {
    const ColourImage right = thesis::blobs(131, 61, 24);
    ColourImage left(right.size());
    for (int y = 0; y < left.rows; ++y)
        for (int x = 0; x < left.cols; ++x) left(y, x) = right(y, std::max(x - 11, 0));
    const DisparityImage disparity = match(left, right, 24, MatchPreset::balanced, true);
    const DisparityImage inside = disparity.colRange(11, 131);
    const int right_ones = cv::countNonZero(inside == 11 * disparity_steps_per_px);
    EXPECT_GT(right_ones, 0.97 * static_cast<double>(inside.total()));
    EXPECT_EQ(cv::countNonZero(disparity), static_cast<int>(disparity.total()));
}

TEST_F(GradientMatcherTest, ReportsItsPassesWhileProfilingAndHoldsTheSameDisparities) {
    const ColourImage left = thesis::blobs(61, 47, 20), right = thesis::blobs(61, 47, 21);
    const auto matcher =
        make_matcher("gradient", library_, settings_of(left, 32, MatchPreset::balanced, true));
    const Texture left_texture = upload(left), right_texture = upload(right);
    const cv::Mat plain = matcher->match(left_texture, right_texture).download();
    EXPECT_TRUE(matcher->passes().empty());
    matcher->set_profiling(true);
    const cv::Mat profiled = matcher->match(left_texture, right_texture).download();
    EXPECT_EQ(cv::norm(plain, profiled, cv::NORM_INF), 0);
    const std::vector<PassReport> passes = matcher->passes();
    const auto aggregation = std::ranges::find(passes, "aggregation", &PassReport::name);
    ASSERT_NE(aggregation, passes.end());
    EXPECT_EQ(aggregation->runs, 8);
    EXPECT_EQ(aggregation->bytes_moved, 8u * 61 * 47 * 4 * (16 + 16 + 4));
    EXPECT_GT(matcher->gpu_bytes(), 2u * 61 * 47 * 32 * 2);
}

/// Share of the pixels of `mask` whose disparity is off by more than 2 px.
double bad_2(const DisparityImage& disparity, const cv::Mat1f& truth_px, const cv::Mat1b& mask) {
    int known = 0, bad = 0;
    for (int y = 0; y < disparity.rows; ++y)
        for (int x = 0; x < disparity.cols; ++x) {
            if (!mask(y, x) || truth_px(y, x) <= 0) continue;
            ++known;
            const float d = static_cast<float>(disparity(y, x)) / disparity_steps_per_px;
            bad += disparity(y, x) == 0 || std::abs(d - truth_px(y, x)) > 2;
        }
    return static_cast<double>(bad) / known;
}

TEST_F(GradientMatcherTest, IsRightOnMostOfTsukubaAndTeddy) {
    VANTAGE_REQUIRE_DATA(data);
    struct Scene {
        const char *folder, *left, *right, *truth, *mask;
        double pixels_per_code;
        int disparities;
        double bad_fast, bad_balanced, bad_quality;
    };
    const Scene scenes[] = {{"middlebury2001/tsukuba", "im3.png", "im4.png", "disp3.png",
                             "mask3_nonocc.png", 1.0 / 16, 16, 0.16, 0.10, 0.07},
                            {"middlebury2003/teddy", "im2.png", "im6.png", "disp2.png",
                             "mask2_nonocc.png", 1.0 / 4, 64, 0.30, 0.18, 0.13}};
    for (const Scene& scene : scenes) {
        const std::filesystem::path folder = data / scene.folder;
        const ColourImage left = read_colour_image(folder / scene.left);
        const ColourImage right = read_colour_image(folder / scene.right);
        cv::Mat1f truth_px;
        read_code_image(folder / scene.truth).convertTo(truth_px, CV_32F, scene.pixels_per_code);
        const cv::Mat1b mask = read_code_image(folder / scene.mask) == 255;
        const auto bad = [&](MatchPreset preset) {
            return bad_2(match(left, right, scene.disparities, preset, true), truth_px, mask);
        };
        EXPECT_LT(bad(MatchPreset::fast), scene.bad_fast) << scene.folder;
        EXPECT_LT(bad(MatchPreset::balanced), scene.bad_balanced) << scene.folder;
        EXPECT_LT(bad(MatchPreset::quality), scene.bad_quality) << scene.folder;
    }
}

TEST_F(GradientMatcherTest, RefusesWhatIsBeyondTheLimitsWithTheLimit) {
    const auto sentence = [&](const MatchSettings& settings) {
        return thrown_sentence([&] { make_matcher("gradient", library_, settings); });
    };
    EXPECT_NE(sentence({.width_px = 61, .height_px = 47, .disparities = 0}).find("1 to 256"),
              std::string::npos);
    EXPECT_NE(sentence({.width_px = 61, .height_px = 47, .disparities = 257}).find("1 to 256"),
              std::string::npos);
    EXPECT_NE(sentence({.width_px = 4097, .height_px = 47}).find("4096"), std::string::npos);
    EXPECT_NE(sentence({.width_px = 61, .height_px = 0}).find("4096"), std::string::npos);
}

}  // namespace
}  // namespace vantage
