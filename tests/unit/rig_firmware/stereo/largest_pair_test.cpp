#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "tests/bench/stereo/filmed_pair.h"

namespace vantage {
namespace {

struct LargestCase {
    const char* matcher;
    int width_px, height_px, disparities, shift_px;
};

class LargestPairTest : public testing::TestWithParam<LargestCase> {
  protected:
    EglContext context_;
    ShaderLibrary library_;
};

/// Noise of a few pixels' grain, the left picture `shift_px` to the right of the right one.
FilmedPair shifted_noise(const LargestCase& c) {
    ColourImage wide(c.height_px, c.width_px + c.shift_px);
    cv::RNG(6).fill(wide, cv::RNG::UNIFORM, 0, 256);
    cv::GaussianBlur(wide, wide, {5, 5}, 1.0);
    return {wide.colRange(0, c.width_px).clone(),
            wide.colRange(c.shift_px, c.shift_px + c.width_px).clone(),
            {}};
}

TEST_P(LargestPairTest, IsMatchedOverItsWholeWidthAndHeight) {
    const LargestCase& c = GetParam();
    const auto matcher = make_matcher(
        c.matcher, library_,
        {.width_px = c.width_px, .height_px = c.height_px, .disparities = c.disparities});
    const cv::Mat1f found = matched(*matcher, shifted_noise(c));
    int right = 0, judged = 0;
    for (int y = 0; y < found.rows; ++y)
        for (int x = c.shift_px + 8; x < found.cols; ++x) {
            ++judged;
            right += std::abs(found(y, x) - static_cast<float>(c.shift_px)) <= 0.5f;
        }
    EXPECT_GT(right, 0.97 * judged);
    const auto end = static_cast<float>(c.shift_px);
    EXPECT_NEAR(found(found.rows - 1, found.cols - 1), end, 0.5);
}

INSTANTIATE_TEST_SUITE_P(
    WideAndHigh, LargestPairTest,
    testing::Values(
        LargestCase{"perm_sgm", 4096, 37, 256, 251}, LargestCase{"row_pairs", 4096, 37, 256, 251},
        LargestCase{"perm", 4096, 37, 256, 251}, LargestCase{"sgm", 4096, 37, 256, 251},
        LargestCase{"coarse", 4096, 37, 256, 250}, LargestCase{"gradient", 4096, 37, 256, 251},
        LargestCase{"perm_sgm", 61, 4096, 16, 9}, LargestCase{"row_pairs", 61, 4096, 16, 9},
        LargestCase{"perm", 61, 4096, 16, 9}, LargestCase{"sgm", 61, 4096, 16, 9},
        LargestCase{"coarse", 61, 4096, 16, 8}, LargestCase{"gradient", 61, 4096, 16, 9}),
    [](const auto& test) {
        return std::string(test.param.matcher) + (test.param.width_px == 4096 ? "_wide" : "_high");
    });

}  // namespace
}  // namespace vantage
