#include "rig_firmware/stereo/volume/sgm_pass.h"

#include <gtest/gtest.h>

#include "common/gl/context/egl_context.h"
#include "rig_firmware/stereo/volume/perm_pass.h"
#include "tests/unit/rig_firmware/stereo/engine_buffers.h"

namespace vantage {
namespace {

constexpr double operations_of_part = 1e5;  // so few that most sizes take several dispatches

class SgmPassTest : public EnginePassTest {
  protected:
    SgmPassTest() {
        Texture left(TextureFormat::rgba8, layout_.width_px, layout_.height_px);
        Texture right(TextureFormat::rgba8, layout_.width_px, layout_.height_px);
        left.upload(pair_.left);
        right.upload(pair_.right);
        luma_.run(profiler_, left, right);
        features_.run(profiler_, luma_);
        permeability_.run(profiler_, luma_.left());
    }

    void expect_winners(const Buffer& buffer, const Winners& winners) {
        const cv::Mat1i best = winners_channel(buffer, layout_, 0),
                        beside = winners_channel(buffer, layout_, 1);
        expect_equal(bits_of(best, 12, 8), winners.disparity, "disparity");
        expect_equal(bits_of(best, 20, 12), winners.cost, "cost");
        expect_equal(bits_of(beside, 12, 12), winners.cost_before, "cost before");
        expect_equal(bits_of(beside, 0, 12), winners.cost_after, "cost after");
    }

    LumaPass luma_{library_, layout_};
    FeaturePass features_{library_, layout_, GetParam().disparities};
    PermeabilityPass permeability_{library_, layout_, 9};
    const cv::Mat1i left_words_ = feature_words(left_), right_words_ = feature_words(right_);
};

TEST_P(SgmPassTest, FourPathsOverTheMatchingCostAgreeWithTheCpuBitForBit) {
    const SgmSettings settings{.p1 = 7, .p2 = 50};
    SgmCostPass cost(library_, layout_, GetParam().disparities, 1);
    cost.run(profiler_, features_);
    const std::vector<cv::Mat1b> costs =
        sgm_costs(left_words_, right_words_, GetParam().disparities, 1);
    expect_equal_costs(cost.costs(), layout_, costs);
    const Winners winners = sgm_winners(costs, settings);
    for (const LaneMapping lanes : {LaneMapping::pixels, LaneMapping::disparities}) {
        SgmPass paths(library_, layout_, GetParam().disparities, settings, lanes,
                      operations_of_part);
        paths.run(profiler_, cost.costs());
        expect_winners(paths.winners(), winners);
    }
}

TEST_P(SgmPassTest, RowPathsOverPermeabilitySumsAgreeWithTheCpuBitForBit) {
    const SgmSettings settings{.p1 = 4, .p2 = 20, .columns = false};
    PermPass perm(library_, layout_, GetParam().disparities, PermOutput::costs);
    perm.run(profiler_, features_, permeability_);
    const std::vector<cv::Mat1b> costs =
        perm_costs(left_words_, right_words_,
                   permeability_of(guide_of(left_), permeability_table(9)), GetParam().disparities);
    expect_equal_costs(perm.costs(), layout_, costs);
    const Winners winners = sgm_winners(costs, settings);
    for (const LaneMapping lanes : {LaneMapping::pixels, LaneMapping::disparities}) {
        SgmPass paths(library_, layout_, GetParam().disparities, settings, lanes,
                      operations_of_part);
        paths.run(profiler_, perm.costs());
        expect_winners(paths.winners(), winners);
    }
    SgmPass in_scratch(library_, layout_, GetParam().disparities, settings, perm.large_scratch(),
                       perm.small_scratch());
    in_scratch.run(profiler_, perm.costs());
    expect_winners(in_scratch.winners(), winners);
}

INSTANTIATE_TEST_SUITE_P(OddSizes, SgmPassTest,
                         testing::Values(PassCase{61, 47, 13}, PassCase{16, 16, 16},
                                         PassCase{51, 263, 37}, PassCase{311, 239, 21},
                                         PassCase{83, 30, 70}));

}  // namespace
}  // namespace vantage
