#include <algorithm>

#include <gtest/gtest.h>

#include "rig_firmware/stereo/thesis/thesis_passes.h"
#include "tests/references/thesis/aggregation_reference.h"
#include "tests/references/thesis/discontinuity_reference.h"
#include "tests/unit/rig_firmware/stereo/thesis_buffers.h"

namespace vantage::thesis {
namespace {

cv::Mat1b random_discontinuities(cv::Size size) {
    return discontinuity_reference(blobs(size.width, size.height, 9), 12);
}

class AggregationPassTest : public testing::TestWithParam<PictureCase> {};

TEST_P(AggregationPassTest, EqualsItsReference) {
    const EglContext context;
    const ShaderLibrary library;
    const PictureCase& size = GetParam();
    const CostVolume costs = random_volume(size, 10);
    const cv::Mat1b cuts = random_discontinuities({size.width_px, size.height_px});
    const Buffer aggregated =
        to_buffer(CostVolume(size.width_px, size.height_px, size.disparities));
    AggregationPass pass(library, cuts.size());
    pass.run(to_buffer(costs), to_buffer(cuts), slices_for(size.disparities), aggregated);
    EXPECT_EQ(volume_in(aggregated, size).costs, aggregation_reference(costs, cuts).costs);
}

TEST_P(AggregationPassTest, HoldsTheHighestCostWithoutOverflow) {
    const EglContext context;
    const ShaderLibrary library;
    const PictureCase& size = GetParam();
    CostVolume costs(size.width_px, size.height_px, size.disparities);
    std::ranges::fill(costs.costs, max_cost);
    const cv::Mat1b cuts = random_discontinuities({size.width_px, size.height_px});
    const Buffer aggregated =
        to_buffer(CostVolume(size.width_px, size.height_px, size.disparities));
    AggregationPass pass(library, cuts.size());
    pass.run(to_buffer(costs), to_buffer(cuts), slices_for(size.disparities), aggregated);
    EXPECT_EQ(volume_in(aggregated, size).costs, costs.costs);
}

INSTANTIATE_TEST_SUITE_P(Sizes, AggregationPassTest, testing::ValuesIn(picture_cases));

TEST(AggregationReference, CarriesNothingAcrossADiscontinuity) {
    ColourImage picture(9, 12, cv::Vec4b(20, 20, 20, 255));
    picture.colRange(6, 12).setTo(cv::Scalar(200, 200, 200, 255));
    const cv::Mat1b cuts = discontinuity_reference(picture, 24);
    CostVolume costs(12, 9, 1);
    for (int y = 0; y < 9; ++y)
        for (int x = 0; x < 12; ++x)
            costs.at(0, y, x) = static_cast<std::uint16_t>(x < 6 ? 100 : 900);
    for (int i = 0; i < 5; ++i) costs = aggregation_reference(costs, cuts);
    for (int y = 0; y < 9; ++y)
        for (int x = 0; x < 12; ++x) EXPECT_EQ(costs.at(0, y, x), x < 6 ? 100 : 900);
}

TEST(AggregationReference, SpreadsACostOverItsNineNeighbours) {
    CostVolume costs(5, 5, 1);
    costs.at(0, 2, 2) = 640;
    const CostVolume spread = aggregation_reference(costs, cv::Mat1b(5, 5, std::uint8_t{0}));
    EXPECT_EQ(spread.at(0, 1, 1), 90);
    EXPECT_EQ(spread.at(0, 1, 2), 60);
    EXPECT_EQ(spread.at(0, 2, 2), 40);
    EXPECT_EQ(spread.at(0, 2, 4), 0);
}

}  // namespace
}  // namespace vantage::thesis
