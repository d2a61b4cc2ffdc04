#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "common/image/image_file.h"
#include "tests/bench/stereo/stereo_measures.h"
#include "tests/support/data_folder.h"

namespace vantage {
namespace {

/// Tsukuba, searched over 16 disparities: its lamp is at 14, next to the last.
class Tsukuba : public testing::Test {
  protected:
    void SetUp() override {
        VANTAGE_REQUIRE_DATA(data);
        const std::filesystem::path folder = data / "middlebury2001/tsukuba";
        left_ = read_colour_image(folder / "im3.png");
        right_ = read_colour_image(folder / "im4.png");
        read_code_image(folder / "disp3.png").convertTo(truth_px_, CV_8U, 1.0 / 16);
    }
    std::unique_ptr<Matcher> matcher_of(MatchPreset preset) const {
        return make_matcher(default_matcher(preset), library_,
                            {.width_px = left_.cols,
                             .height_px = left_.rows,
                             .disparities = 16,
                             .preset = preset,
                             .confidence = true});
    }

    const EglContext context_;
    const ShaderLibrary library_;
    ColourImage left_, right_;
    GreyImage truth_px_;
};

constexpr MatchPreset presets[] = {MatchPreset::quality, MatchPreset::balanced, MatchPreset::fast};

TEST_F(Tsukuba, RepeatedSpinesHaveNoFalseBarBeforeThem) {
    const cv::Rect stats(40, 40, 70, 50);
    double farthest = 0, nearest = 0;
    cv::minMaxLoc(truth_px_(stats), &farthest, &nearest);
    for (const MatchPreset preset : presets) {
        const auto matcher = matcher_of(preset);
        const cv::Mat1f found = matched(*matcher, {left_, right_, {}})(stats);
        EXPECT_EQ(cv::countNonZero(found > nearest + 2), 0) << static_cast<int>(preset);
    }
}

TEST_F(Tsukuba, TheLampIsSureThoughTheSearchEndsRightBehindIt) {
    const cv::Mat1b lamp = truth_px_ == 14;
    ASSERT_GT(cv::countNonZero(lamp), 1000);
    for (const MatchPreset preset : presets) {
        const auto matcher = matcher_of(preset);
        matched(*matcher, {left_, right_, {}});
        const cv::Mat1b confidence = matcher->confidence()->download();
        EXPECT_GT(cv::mean(confidence, lamp)[0], 100) << static_cast<int>(preset);
    }
}

}  // namespace
}  // namespace vantage
