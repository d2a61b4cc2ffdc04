#include <gtest/gtest.h>

#include "rig_firmware/stereo/thesis/thesis_passes.h"
#include "tests/references/thesis/winner_reference.h"
#include "tests/unit/rig_firmware/stereo/thesis_buffers.h"

namespace vantage::thesis {
namespace {

class WinnerPassTest : public testing::TestWithParam<PictureCase> {};

TEST_P(WinnerPassTest, EqualsItsReference) {
    const EglContext context;
    const ShaderLibrary library;
    const PictureCase& size = GetParam();
    const CostVolume costs = random_volume(size, 12);
    const cv::Size pixels(size.width_px, size.height_px);
    const Buffer keys = empty_words(pixels);
    WinnerPass pass(library, pixels);
    pass.run(to_buffer(costs), 0, slices_for(size.disparities), keys);
    EXPECT_EQ(cv::norm(codes_in(keys, pixels), winner_reference(costs), cv::NORM_INF), 0);
}

INSTANTIATE_TEST_SUITE_P(Sizes, WinnerPassTest, testing::ValuesIn(picture_cases));

TEST(WinnerPass, CarriesTheWinnerFromBatchToBatch) {
    const EglContext context;
    const ShaderLibrary library;
    const CostVolume costs = random_volume({61, 47, 32}, 13);
    const cv::Size pixels(61, 47);
    WinnerPass pass(library, pixels);
    const Buffer keys = empty_words(pixels);
    for (int first = 0; first < 32; first += 16) {
        CostVolume batch(61, 47, 16);
        for (int d = 0; d < 16; ++d)
            for (int y = 0; y < 47; ++y)
                for (int x = 0; x < 61; ++x) batch.at(d, y, x) = costs.at(first + d, y, x);
        pass.run(to_buffer(batch), first, 2, keys);
    }
    EXPECT_EQ(cv::norm(codes_in(keys, pixels), winner_reference(costs), cv::NORM_INF), 0);
}

TEST(WinnerReference, TakesTheSmallestDisparityAtEqualCost) {
    CostVolume costs(1, 1, 9);
    std::ranges::fill(costs.costs, 7);
    EXPECT_EQ(winner_reference(costs)(0, 0), 0);
    costs.at(4, 0, 0) = costs.at(6, 0, 0) = 3;
    EXPECT_EQ(winner_reference(costs)(0, 0), 4);
}

}  // namespace
}  // namespace vantage::thesis
