#include <cmath>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "common/image/image_file.h"
#include "tests/unit/stereo/filmed_pair.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;

/// Whether a plane of at least a hundredth of a pixel's disparity a pixel fits around x, y.
bool lies_on_slanted_plane(const cv::Mat1f& disparity_px, int x, int y) {
    constexpr int radius = 5;
    constexpr float least_slope = 0.01f, flatness_px = 0.02f;
    if (x < radius || y < radius || x + radius >= disparity_px.cols ||
        y + radius >= disparity_px.rows)
        return false;
    const float here = disparity_px(y, x);
    const float along = (disparity_px(y, x + radius) - disparity_px(y, x - radius)) / (2 * radius);
    const float down = (disparity_px(y + radius, x) - disparity_px(y - radius, x)) / (2 * radius);
    if (std::hypot(along, down) < least_slope) return false;
    for (int j = -radius; j <= radius; ++j)
        for (int i = -radius; i <= radius; ++i) {
            const float plane = here + along * static_cast<float>(i) + down * static_cast<float>(j);
            if (std::abs(disparity_px(y + j, x + i) - plane) > flatness_px) return false;
        }
    return true;
}

/// 255 where rows have something to be matched by: grey levels that change by 4 a pixel.
cv::Mat1b textured_along_rows(const GreyImage& luma) {
    cv::Mat1f step, energy;
    cv::Sobel(luma, step, CV_32F, 1, 0, 1, 0.5);
    cv::boxFilter(step.mul(step), energy, CV_32F, {9, 7});
    return energy >= 16;
}

class SubpixelTest : public testing::TestWithParam<std::uint64_t> {
  protected:
    EglContext context_;
    ShaderLibrary library_;
};

TEST_P(SubpixelTest, IsWithinASeventhOfAPixelOnSlantedPlanesUnderSensorNoise) {
    VirtualStage stage =
        GetParam() == 0 ? VirtualStage(library_) : VirtualStage(library_, GetParam());
    StageFilm film(
        stage,
        {.azimuth_rad = 0.4 * static_cast<double>(GetParam()), .width_px = 449, .height_px = 337});
    const FilmedPair pair = film.at(1s, {.sigma = 1});
    const cv::Mat1b textured = textured_along_rows(to_grey(pair.left));
    for (const MatchPreset preset : {MatchPreset::quality, MatchPreset::balanced}) {
        const auto matcher =
            make_matcher(default_matcher(preset), library_,
                         {.width_px = 449, .height_px = 337, .disparities = 48, .preset = preset});
        const cv::Mat1f found = matched(*matcher, pair);
        double squares = 0;
        int judged = 0, inliers = 0;
        for (int y = 0; y < found.rows; ++y)
            for (int x = 48; x < found.cols; ++x) {
                if (!textured(y, x) || !lies_on_slanted_plane(pair.disparity_px, x, y)) continue;
                ++judged;
                const double error = found(y, x) - pair.disparity_px(y, x);
                if (std::abs(error) >= 1) continue;
                ++inliers;
                squares += error * error;
            }
        EXPECT_GT(judged, 4000);
        EXPECT_GE(inliers, 0.97 * judged);
        const double rms_px = std::sqrt(squares / inliers);
        EXPECT_LE(rms_px, 0.15) << default_matcher(preset);
        RecordProperty(default_matcher(preset), std::to_string(rms_px));
    }
}

INSTANTIATE_TEST_SUITE_P(RandomSets, SubpixelTest, testing::Values(0, 1, 2, 3));

}  // namespace
}  // namespace vantage
