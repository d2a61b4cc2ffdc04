#include <gtest/gtest.h>

#include "rig_firmware/stereo/thesis/thesis_passes.h"
#include "tests/references/thesis/disparity_reference.h"
#include "tests/unit/rig_firmware/stereo/thesis_buffers.h"

namespace vantage::thesis {
namespace {

class DisparityPassTest : public testing::TestWithParam<PictureCase> {};

TEST_P(DisparityPassTest, EqualsItsReferenceFilledAndNot) {
    const EglContext context;
    const ShaderLibrary library;
    const PictureCase& size = GetParam();
    cv::Mat1b winners(size.height_px, size.width_px);
    cv::RNG(14).fill(winners, cv::RNG::UNIFORM, 0, size.disparities);
    const Buffer keys = to_buffer(winners);
    for (const bool fill : {true, false}) {
        DisparityPass pass(library, winners.size(), fill);
        EXPECT_EQ(
            cv::norm(pass.run(keys).download(), disparity_reference(winners, fill), cv::NORM_INF),
            0)
            << (fill ? "filled" : "not filled");
    }
}

INSTANTIATE_TEST_SUITE_P(Sizes, DisparityPassTest, testing::ValuesIn(picture_cases));

TEST(DisparityReference, FillsTheRimFromTheRightAndTellsInfinityFromUnknown) {
    const cv::Mat1b winners = (cv::Mat1b(1, 5) << 3, 4, 2, 0, 1);
    const DisparityImage filled = (DisparityImage(1, 5) << 64, 64, 64, 1, 32);
    const DisparityImage sparse = (DisparityImage(1, 5) << 0, 0, 64, 1, 32);
    EXPECT_EQ(cv::norm(disparity_reference(winners, true), filled, cv::NORM_INF), 0);
    EXPECT_EQ(cv::norm(disparity_reference(winners, false), sparse, cv::NORM_INF), 0);
    const cv::Mat1b beyond(1, 3, std::uint8_t{9});
    EXPECT_EQ(cv::countNonZero(disparity_reference(beyond, true)), 0);
}

}  // namespace
}  // namespace vantage::thesis
