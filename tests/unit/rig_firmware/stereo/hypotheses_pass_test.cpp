#include <gtest/gtest.h>

#include "rig_firmware/stereo/thesis/thesis_passes.h"
#include "tests/references/thesis/hypotheses_reference.h"
#include "tests/unit/rig_firmware/stereo/thesis_buffers.h"

namespace vantage::thesis {
namespace {

class HypothesesPassTest : public testing::TestWithParam<PictureCase> {};

TEST_P(HypothesesPassTest, EqualsItsReferenceAndPadsWithTheHighestCost) {
    const EglContext context;
    const ShaderLibrary library;
    const PictureCase& size = GetParam();
    const ColourImage left = blobs(size.width_px, size.height_px, 6);
    const ColourImage right = blobs(size.width_px, size.height_px, 7);
    const int slices = slices_for(size.disparities);
    const Buffer costs = to_buffer(CostVolume(size.width_px, size.height_px, 8 * slices));
    HypothesesPass pass(library, left.size(), size.disparities);
    pass.run(to_buffer(left), to_buffer(right), 0, slices, costs);
    EXPECT_EQ(volume_in(costs, size).costs,
              hypotheses_reference(left, right, size.disparities).costs);
    const CostVolume padded = volume_in(costs, {size.width_px, size.height_px, 8 * slices});
    for (int d = size.disparities; d < padded.disparities; ++d)
        EXPECT_EQ(padded.at(d, size.height_px - 1, 0), max_cost) << "disparity " << d;
}

INSTANTIATE_TEST_SUITE_P(Sizes, HypothesesPassTest, testing::ValuesIn(picture_cases));

TEST(HypothesesPass, StartsABatchInTheMiddleOfTheSearch) {
    const EglContext context;
    const ShaderLibrary library;
    const ColourImage left = blobs(61, 47, 6), right = blobs(61, 47, 7);
    const Buffer costs = to_buffer(CostVolume(61, 47, 16));
    HypothesesPass pass(library, left.size(), 32);
    pass.run(to_buffer(left), to_buffer(right), 8, 2, costs);
    const CostVolume whole = hypotheses_reference(left, right, 32);
    const CostVolume batch = volume_in(costs, {61, 47, 16});
    for (const int d : {0, 7, 8, 15})
        for (int x = 0; x < 61; ++x) EXPECT_EQ(batch.at(d, 20, x), whole.at(d + 8, 20, x));
}

TEST(HypothesesReference, CostsNothingWhereThePicturesAgree) {
    const ColourImage right = blobs(61, 9, 8);
    ColourImage left(right.size());
    for (int y = 0; y < left.rows; ++y)
        for (int x = 0; x < left.cols; ++x) left(y, x) = right(y, std::max(x - 5, 0));
    const CostVolume costs = hypotheses_reference(left, right, 8);
    for (int x = 0; x < 61; ++x) EXPECT_EQ(costs.at(5, 4, x), 0);
    EXPECT_GT(costs.at(2, 4, 40), 0);
}

}  // namespace
}  // namespace vantage::thesis
