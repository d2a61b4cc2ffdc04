#include <cstring>

#include <gtest/gtest.h>

#include "common/gl/context/egl_context.h"
#include "rig_firmware/stereo/disparity/left_right_pass.h"
#include "rig_firmware/stereo/disparity/median_pass.h"
#include "rig_firmware/stereo/disparity/path_fill_pass.h"
#include "rig_firmware/stereo/disparity/result_pass.h"
#include "rig_firmware/stereo/disparity/row_fill_pass.h"
#include "rig_firmware/stereo/disparity/smooth_pass.h"
#include "rig_firmware/stereo/disparity/upsample_pass.h"
#include "rig_firmware/stereo/features/feature_pass.h"
#include "rig_firmware/stereo/features/halve_pass.h"
#include "rig_firmware/stereo/volume/halved_cost_pass.h"
#include "rig_firmware/stereo/volume/perm_cost_pass.h"
#include "rig_firmware/stereo/volume/perm_pass.h"
#include "tests/references/stereo/halved_cost_reference.h"
#include "tests/references/stereo/left_right_reference.h"
#include "tests/references/stereo/median_reference.h"
#include "tests/references/stereo/path_fill_reference.h"
#include "tests/references/stereo/perm_reference.h"
#include "tests/references/stereo/row_fill_reference.h"
#include "tests/references/stereo/sgm_reference.h"
#include "tests/references/stereo/smooth_reference.h"
#include "tests/references/stereo/support_reference.h"
#include "tests/references/stereo/upsample_reference.h"
#include "tests/unit/rig_firmware/stereo/engine_buffers.h"

namespace vantage {
namespace {

constexpr LaneMapping lane_mappings[] = {LaneMapping::pixels, LaneMapping::disparities};

class EnginePassesTest : public EnginePassTest {
  protected:
    void expect_permeabilities(const PermeabilityPass& pass, const cv::Mat1b& permeability) const {
        std::vector<unsigned char> along(pass.along().bytes()), down(pass.down().bytes());
        pass.along().read(0, std::as_writable_bytes(std::span(along)));
        pass.down().read(0, std::as_writable_bytes(std::span(down)));
        for (int y = 0; y < permeability.rows; ++y)
            for (int x = 0; x < permeability.cols; ++x) {
                const int row_at = y * layout_.stride_px() + x,
                          column_at = (y / 4 * layout_.stride_px() + x) * 4 + y % 4;
                ASSERT_EQ(along[static_cast<std::size_t>(row_at)], permeability(y, x) & 15);
                ASSERT_EQ(down[static_cast<std::size_t>(column_at)], permeability(y, x) >> 4);
            }
    }
};

TEST_P(EnginePassesTest, AgreeWithTheirCpuFormsBitForBit) {
    Texture left(TextureFormat::rgba8, layout_.width_px, layout_.height_px);
    Texture right(TextureFormat::rgba8, layout_.width_px, layout_.height_px);
    left.upload(pair_.left);
    right.upload(pair_.right);
    constexpr double sigma = 20;
    FeaturePass features(library_, layout_, GetParam().disparities);
    PermeabilityPass permeabilities(library_, layout_, sigma);
    LumaPass luma(library_, layout_);
    luma.run(profiler_, left, right);
    features.run(profiler_, luma);
    permeabilities.run(profiler_, luma.left());
    const cv::Mat1i left_words = feature_words(left_);
    const StereoPlanes right_rows =
        rows_shifted(right_, row_shift(left_words, feature_words(right_), GetParam().disparities));
    const cv::Mat1i right_words = feature_words(right_rows);
    expect_equal(channel_of(features.left_features(), layout_, 1, 0), left_words, "left feature");
    expect_equal(channel_of(features.right_features(), layout_, 1, 0), right_words,
                 "right feature");
    const cv::Mat1b permeability = permeability_of(guide_of(left_), permeability_table(sigma));
    expect_permeabilities(permeabilities, permeability);

    PermPass perm(library_, layout_, GetParam().disparities);
    perm.run(profiler_, features, permeabilities);
    const Winners winners =
        perm_winners(left_words, right_words, permeability, GetParam().disparities);
    expect_equal(channel_of(perm.weight(), layout_, 1, 0), winners.weight, "weight");
    const cv::Mat1i best = winners_channel(perm.winners(), layout_, 0),
                    beside = winners_channel(perm.winners(), layout_, 1);
    expect_equal(bits_of(best, 12, 8), winners.disparity, "disparity");
    expect_equal(bits_of(best, 20, 12), winners.cost, "cost");
    expect_equal(bits_of(beside, 12, 12), winners.cost_before, "cost before");
    expect_equal(bits_of(beside, 0, 12), winners.cost_after, "cost after");

    PermPass other_lanes(library_, layout_, GetParam().disparities, PermOutput::winners,
                         PermCosts::found, max_perm_code, LaneMapping::disparities);
    other_lanes.run(profiler_, features, permeabilities);
    for (const int word : {0, 1})
        expect_equal(winners_channel(other_lanes.winners(), layout_, word),
                     winners_channel(perm.winners(), layout_, word), "lanes along disparities");

    LeftRightPass check(library_, layout_);
    check.run(profiler_, perm.winners(), &perm.weight());
    const CheckedDisparity checked = left_right_checked(winners);
    const cv::Mat1i words = channel_of(check.disparity(), layout_, 1, 0);
    expect_equal(lower_half(words), as_int(checked.disparity), "checked disparity");
    expect_equal(upper_half(words), as_int(checked.confidence), "confidence");
    LeftRightPass flat_check(library_, layout_, Valley::flat);
    flat_check.run(profiler_, perm.winners(), &perm.weight());
    expect_equal(lower_half(channel_of(flat_check.disparity(), layout_, 1, 0)),
                 as_int(left_right_checked(winners, Valley::flat).disparity),
                 "checked disparity of flat valleys");

    const DisparityImage supported = supported_disparity(checked.disparity);
    for (const LaneMapping lanes : lane_mappings) {
        SupportPass support(library_, layout_, lanes);
        support.run(profiler_, check.disparity(), check.scratch());
        expect_equal(lower_half(channel_of(check.scratch(), layout_, 1, 0)), as_int(supported),
                     "supported");
    }

    RowFillPass row_fill(library_, layout_);
    row_fill.run(profiler_, check.disparity(), check.scratch());
    const DisparityImage filled_rows = filled_from_background(checked.disparity, supported);
    expect_equal(lower_half(channel_of(check.scratch(), layout_, 1, 0)), as_int(filled_rows),
                 "filled along rows");

    PathFillPass path_fill(library_, layout_, FillCell::two_px);
    path_fill.run(profiler_, luma.left(), check.disparity(), check.scratch());
    const DisparityImage filled = filled_along_paths(checked.disparity, left_, FillCell::two_px);
    expect_equal(lower_half(channel_of(check.scratch(), layout_, 1, 0)), as_int(filled),
                 "filled along paths");

    const DisparityImage smoothed = smoothed_where_near(filled);
    for (const LaneMapping lanes : lane_mappings) {
        path_fill.run(profiler_, luma.left(), check.disparity(), check.scratch());
        SmoothPass smooth(library_, layout_, disparity_steps_per_px, lanes);
        smooth.run(profiler_, check.scratch());
        expect_equal(lower_half(channel_of(check.scratch(), layout_, 1, 0)), as_int(smoothed),
                     "smoothed");
    }
    EXPECT_GT(cv::norm(smoothed, filled, cv::NORM_L1), 0) << "nothing was there to be smoothed";

    MedianPass median(library_, layout_);
    const Buffer medians(check.disparity().bytes(), GL_DYNAMIC_COPY);
    median.run(profiler_, check.scratch(), medians);
    expect_equal(lower_half(channel_of(medians, layout_, 1, 0)), as_int(median_of_known(smoothed)),
                 "dense median");
    median.run(profiler_, check.disparity(), medians);
    const cv::Mat1i median_words = channel_of(medians, layout_, 1, 0);
    expect_equal(lower_half(median_words), as_int(median_of_known(checked.disparity)),
                 "median of what is known");
    expect_equal(upper_half(median_words), as_int(checked.confidence), "confidence of the median");

    ResultPass result(library_, layout_);
    expect_equal(as_int(result.run(profiler_, check.disparity()).download()),
                 as_int(checked.disparity), "result");
    ResultPass with_confidence(library_, layout_, true);
    with_confidence.run(profiler_, check.disparity());
    expect_equal(as_int(with_confidence.confidence()->download()), as_int(checked.confidence),
                 "confidence of the result");
}

TEST(FillFromBackground, DoesNotSpreadWhatStandsAlone) {
    DisparityImage disparity(31, 41, static_cast<unsigned short>(320));
    disparity.colRange(10, 20) = 640;
    disparity.colRange(20, 27) = 0;
    disparity(cv::Rect(22, 15, 2, 2)) = 32;
    const DisparityImage filled = filled_from_background(disparity, supported_disparity(disparity));
    EXPECT_EQ(filled(15, 20), 320);
    EXPECT_EQ(filled(15, 26), 320);
    EXPECT_EQ(filled(15, 22), 32) << "what is known stays";
}

TEST(FillFromBackground, TakesWhatThereIsInARowThatHasNothingBetter) {
    DisparityImage disparity(9, 41, static_cast<unsigned short>(0));
    disparity(4, 7) = 64;
    const DisparityImage filled = filled_from_background(disparity, supported_disparity(disparity));
    EXPECT_EQ(cv::countNonZero(filled.row(4) == 64), 41);
    EXPECT_EQ(cv::countNonZero(filled), 41);
}

TEST_P(EnginePassesTest, ARightPictureThatLiesLowerIsPutRight) {
    for (const int shift : {-2, -1, 0, 1}) {
        const StereoPlanes lower = rows_shifted(right_, -shift);
        const cv::Mat1i left_words = feature_words(left_), words = feature_words(lower);
        if (layout_.width_px > 100) {
            EXPECT_EQ(row_shift(left_words, words, GetParam().disparities), shift);
        }
        const int found = row_shift(left_words, words, GetParam().disparities);
        Texture left(TextureFormat::rgba8, layout_.width_px, layout_.height_px);
        Texture right(TextureFormat::rgba8, layout_.width_px, layout_.height_px);
        left.upload(pair_.left);
        ColourImage right_picture(pair_.right.size());
        for (int y = 0; y < right_picture.rows; ++y)
            pair_.right.row(std::clamp(y - shift, 0, right_picture.rows - 1))
                .copyTo(right_picture.row(y));
        right.upload(right_picture);
        LumaPass luma(library_, layout_);
        luma.run(profiler_, left, right);
        FeaturePass features(library_, layout_, GetParam().disparities);
        features.run(profiler_, luma);
        expect_equal(channel_of(features.right_features(), layout_, 1, 0),
                     feature_words(rows_shifted(lower, found)), "right feature");
    }
}

TEST_P(EnginePassesTest, HalveAndUpsampleAsTheCpuDoes) {
    Texture left(TextureFormat::rgba8, layout_.width_px, layout_.height_px);
    left.upload(pair_.left);
    LumaPass fine(library_, layout_);
    fine.run(profiler_, left, left);
    HalvePass halve(library_, layout_);
    halve.run(profiler_, fine.left());
    const StereoLayout half = halved(layout_);
    const StereoPlanes half_left = halved(left_);
    std::vector<unsigned char> bytes(halve.luma().bytes());
    halve.luma().read(0, std::as_writable_bytes(std::span(bytes)));
    for (int y = 0; y < half.height_px; ++y)
        for (int x = -4; x < half.width_px + 4; ++x) {
            const int nearest = std::clamp(x, 0, half.width_px - 1);
            const auto at = static_cast<std::size_t>(4 * y * half.luma_row_words() + 4 + x);
            ASSERT_EQ(bytes[at], half_left.luma(y, nearest)) << x << ", " << y;
            ASSERT_EQ(bytes[half.luma_words() * 4 + at], half_left.colour(y, nearest))
                << x << ", " << y;
        }

    DisparityImage disparity(half.height_px, half.width_px);
    cv::RNG random(11);
    for (int y = 0; y < half.height_px; ++y)
        for (int x = 0; x < half.width_px; ++x) {
            const int surface = (x / 8 + y / 8) % 2 ? 300 : random.uniform(0, 1000);
            disparity(y, x) = static_cast<unsigned short>(surface + x + random.uniform(0, 8));
        }
    UpsamplePass upsample(library_, half, layout_);
    upsample.run(profiler_, buffer_of(disparity, half, 77), halve.luma(), fine.left());
    const cv::Mat1i fine_words = channel_of(upsample.disparity(), layout_, 1, 0);
    expect_equal(lower_half(fine_words), as_int(upsampled(disparity, half_left.luma, left_.luma)),
                 "upsampled");
    expect_equal(upper_half(fine_words), cv::Mat1i(fine_words.size(), 77), "confidence");

    UpsamplePass without_confidence(library_, half, layout_, DisparityForm::halves);
    without_confidence.run(profiler_, buffer_of(disparity, half, 77), halve.luma(), fine.left());
    EXPECT_EQ(without_confidence.disparity().bytes(), upsample.disparity().bytes() / 2);
    ResultPass result(library_, layout_, false, DisparityForm::halves);
    expect_equal(as_int(result.run(profiler_, without_confidence.disparity()).download()),
                 lower_half(fine_words), "result of 16 bits");
}

TEST_P(EnginePassesTest, HalveAndUpsampleRowsAsTheCpuDoes) {
    Texture left(TextureFormat::rgba8, layout_.width_px, layout_.height_px);
    left.upload(pair_.left);
    LumaPass fine(library_, layout_);
    fine.run(profiler_, left, left);
    HalvePass halve(library_, layout_, HalvedSides::height);
    halve.run(profiler_, fine.left());
    const StereoLayout half = with_half_the_rows(layout_);
    const StereoPlanes half_left = with_half_the_rows(left_);
    std::vector<unsigned char> bytes(halve.luma().bytes());
    halve.luma().read(0, std::as_writable_bytes(std::span(bytes)));
    for (int y = 0; y < half.height_px; ++y)
        for (int x = -4; x < half.width_px + 4; ++x) {
            const int nearest = std::clamp(x, 0, half.width_px - 1);
            const auto at = static_cast<std::size_t>(4 * y * half.luma_row_words() + 4 + x);
            ASSERT_EQ(bytes[at], half_left.luma(y, nearest)) << x << ", " << y;
            ASSERT_EQ(bytes[half.luma_words() * 4 + at], half_left.colour(y, nearest))
                << x << ", " << y;
        }

    DisparityImage disparity(half.height_px, half.width_px);
    cv::RNG random(11);
    for (int y = 0; y < half.height_px; ++y)
        for (int x = 0; x < half.width_px; ++x) {
            const int surface = (x / 8 + y / 8) % 2 ? 300 : random.uniform(0, 1000);
            const bool is_known = random.uniform(0, 10) > 0;
            disparity(y, x) =
                static_cast<unsigned short>(is_known ? surface + x + random.uniform(0, 50) : 0);
        }
    UpsampleRowsPass upsample(library_, layout_);
    upsample.run(profiler_, buffer_of(disparity, half, 77), halve.luma(), fine.left());
    const cv::Mat1i fine_words = channel_of(upsample.disparity(), layout_, 1, 0);
    expect_equal(lower_half(fine_words),
                 as_int(upsampled_rows(disparity, half_left.luma, left_.luma)), "upsampled");
    expect_equal(upper_half(fine_words), cv::Mat1i(fine_words.size(), 77), "confidence");

    UpsampleRowsPass without_confidence(library_, layout_, DisparityForm::halves);
    without_confidence.run(profiler_, buffer_of(disparity, half, 77), halve.luma(), fine.left());
    ResultPass result(library_, layout_, false, DisparityForm::halves);
    expect_equal(as_int(result.run(profiler_, without_confidence.disparity()).download()),
                 lower_half(fine_words), "result of 16 bits");
}

TEST_P(EnginePassesTest, CostsAtHalfTheSizeAndTheirAggregationAgreeWithTheCpuBitForBit) {
    Texture left(TextureFormat::rgba8, layout_.width_px, layout_.height_px);
    Texture right(TextureFormat::rgba8, layout_.width_px, layout_.height_px);
    left.upload(pair_.left);
    right.upload(pair_.right);
    LumaPass luma(library_, layout_);
    luma.run(profiler_, left, right);
    FeaturePass features(library_, layout_, GetParam().disparities);
    features.run(profiler_, luma);
    HalvePass halve(library_, layout_);
    halve.run(profiler_, luma.left());
    const StereoLayout half = halved(layout_);
    constexpr double sigma = 5;
    PermeabilityPass permeabilities(library_, half, sigma, PermeabilityGuide::plain);
    permeabilities.run(profiler_, halve.luma());
    const auto words_of_even_width = [](const StereoPlanes& picture) {
        StereoPlanes even;
        const int more = picture.luma.cols % 2;
        cv::copyMakeBorder(picture.luma, even.luma, 0, 0, 0, more, cv::BORDER_REPLICATE);
        cv::copyMakeBorder(picture.colour, even.colour, 0, 0, 0, more, cv::BORDER_REPLICATE);
        return feature_words(even);
    };
    constexpr double max_operations = 1e5;  // so few that most sizes take several dispatches
    for (const HalvedCostSamples samples : {HalvedCostSamples::one, HalvedCostSamples::two})
        for (const LaneMapping lanes : lane_mappings) {
            const int most_code = samples == HalvedCostSamples::one ? max_perm_code : 69;
            const std::vector<cv::Mat1b> costs =
                halved_costs(words_of_even_width(left_), words_of_even_width(right_),
                             GetParam().disparities, samples);
            HalvedCostPass cost(library_, layout_, GetParam().disparities, samples, lanes,
                                max_operations);
            PermPass perm(library_, half, static_cast<int>(costs.size()), PermOutput::costs,
                          PermCosts::given, most_code, lanes);
            cost.run(profiler_, features, perm.costs());
            expect_equal_costs(perm.costs(), half, costs, ByteOrder::of_sums);
            perm.run(profiler_, permeabilities);
            expect_equal_costs(
                perm.costs(), half,
                perm_costs(costs, permeability_of(halved(left_), permeability_table(sigma)),
                           most_code));
        }
}

TEST_P(EnginePassesTest, FeaturesOfOneRowOfTwoAreThoseOfAllRows) {
    Texture left(TextureFormat::rgba8, layout_.width_px, layout_.height_px);
    Texture right(TextureFormat::rgba8, layout_.width_px, layout_.height_px);
    left.upload(pair_.left);
    right.upload(pair_.right);
    LumaPass luma(library_, layout_);
    luma.run(profiler_, left, right);
    const auto one_row_of_two = [&](const Buffer& features) {
        const cv::Mat1i words = channel_of(features, layout_, 1, 0);
        cv::Mat1i rows((words.rows + 1) / 2, words.cols);
        for (int y = 0; y < rows.rows; ++y)
            words.row(std::min(2 * y + y % 2, words.rows - 1)).copyTo(rows.row(y));
        return rows;
    };
    FeaturePass all(library_, layout_, GetParam().disparities, PictureKind::of_stream);
    FeaturePass some(library_, layout_, GetParam().disparities, PictureKind::of_stream,
                     FeatureRows::one_of_two);
    // Rows are compared in the first frame, which needs them all.
    for (const char* frame : {"compared", "not compared"}) {
        all.run(profiler_, luma);
        some.run(profiler_, luma);
        expect_equal(one_row_of_two(some.left_features()), one_row_of_two(all.left_features()),
                     frame);
        expect_equal(one_row_of_two(some.right_features()), one_row_of_two(all.right_features()),
                     frame);
        luma.run(profiler_, right, left);
    }
}

TEST_P(EnginePassesTest, CostsThatAreComputedBeforeTheirAggregationLeaveTheSameBits) {
    Texture left(TextureFormat::rgba8, layout_.width_px, layout_.height_px);
    Texture right(TextureFormat::rgba8, layout_.width_px, layout_.height_px);
    left.upload(pair_.left);
    right.upload(pair_.right);
    LumaPass luma(library_, layout_);
    luma.run(profiler_, left, right);
    FeaturePass features(library_, layout_, GetParam().disparities);
    features.run(profiler_, luma);
    PermeabilityPass permeabilities(library_, layout_, 8);
    permeabilities.run(profiler_, luma.left());
    PermPass perm(library_, layout_, GetParam().disparities, PermOutput::costs, PermCosts::given,
                  max_perm_code, LaneMapping::disparities);
    constexpr double max_operations = 1e5;  // so few that most sizes take several dispatches
    PermCostPass cost(library_, layout_, GetParam().disparities, CostRows::all,
                      LaneMapping::disparities, max_operations);
    cost.run(profiler_, features, perm.costs());
    const cv::Mat1i left_words = channel_of(features.left_features(), layout_, 1, 0),
                    right_words = channel_of(features.right_features(), layout_, 1, 0);
    expect_equal_costs(perm.costs(), layout_,
                       sgm_costs(left_words, right_words, GetParam().disparities, 1),
                       ByteOrder::of_sums);
    perm.run(profiler_, permeabilities);
    expect_equal_costs(
        perm.costs(), layout_,
        perm_costs(left_words, right_words, permeability_of(guide_of(left_), permeability_table(8)),
                   GetParam().disparities));
}

TEST_P(EnginePassesTest, CostsOfPairsOfRowsAgreeWithTheCpuBitForBit) {
    Texture left(TextureFormat::rgba8, layout_.width_px, layout_.height_px);
    Texture right(TextureFormat::rgba8, layout_.width_px, layout_.height_px);
    left.upload(pair_.left);
    right.upload(pair_.right);
    LumaPass luma(library_, layout_);
    luma.run(profiler_, left, right);
    FeaturePass features(library_, layout_, GetParam().disparities);
    features.run(profiler_, luma);
    const StereoLayout half = with_half_the_rows(layout_);
    const std::vector<cv::Mat1b> costs =
        paired_costs(channel_of(features.left_features(), layout_, 1, 0),
                     channel_of(features.right_features(), layout_, 1, 0), GetParam().disparities);
    for (const LaneMapping lanes : lane_mappings)
        for (const double max_operations : {1e5, max_dispatch_operations}) {
            const PermPass perm(library_, half, GetParam().disparities, PermOutput::costs,
                                PermCosts::given, max_perm_code, lanes);
            PermCostPass cost(library_, layout_, GetParam().disparities, CostRows::pairs, lanes,
                              max_operations);
            cost.run(profiler_, features, perm.costs());
            expect_equal_costs(perm.costs(), half, costs, ByteOrder::of_sums);
        }
}

TEST(DispatchInParts, CoversAllLinesInEqualPieces) {
    const auto pieces = [](int lines, int step, double operations) {
        std::vector<std::pair<int, int>> found;
        dispatch_in_parts(lines, step, operations, 100,
                          [&](int first, int count) { found.emplace_back(first, count); });
        return found;
    };
    using Pieces = std::vector<std::pair<int, int>>;
    EXPECT_EQ(pieces(40, 16, 100), (Pieces{{0, 40}}));
    EXPECT_EQ(pieces(100, 16, 250), (Pieces{{0, 48}, {48, 48}, {96, 4}}));
    EXPECT_EQ(pieces(3, 1, 1e9), (Pieces{{0, 1}, {1, 1}, {2, 1}}));
    EXPECT_EQ(pieces(0, 16, 0), Pieces());
}

TEST(RowShiftOfAStream, IsComparedSeldomAndAnewAfterForget) {
    const EglContext context;
    const ShaderLibrary library;
    constexpr int width = 320, height = 128, disparities = 16;
    const StereoLayout layout{width, height};
    const TexturedPair pair = textured_pair(width, height);
    ColourImage lower(pair.right.size());
    for (int y = 0; y < height; ++y) pair.right.row(std::max(y - 1, 0)).copyTo(lower.row(y));
    PassProfiler profiler;
    LumaPass luma(library, layout), luma_lower(library, layout);
    Texture left(TextureFormat::rgba8, width, height), right(TextureFormat::rgba8, width, height);
    left.upload(pair.left);
    right.upload(pair.right);
    luma.run(profiler, left, right);
    Texture right_lower(TextureFormat::rgba8, width, height);
    right_lower.upload(lower);
    luma_lower.run(profiler, left, right_lower);

    FeaturePass of_single(library, layout, disparities);
    const auto words = [&](const FeaturePass& pass) {
        return channel_of(pass.right_features(), layout, 1, 0);
    };
    of_single.run(profiler, luma_lower);
    const cv::Mat1i put_right = words(of_single);

    FeaturePass of_stream(library, layout, disparities, PictureKind::of_stream);
    of_stream.run(profiler, luma);
    for (int frame = 1; frame < FeaturePass::row_shift_period_frames; ++frame)
        of_stream.run(profiler, luma_lower);
    EXPECT_GT(cv::norm(words(of_stream), put_right, cv::NORM_L1), 0)
        << "rows were compared although the period had not passed";
    of_stream.run(profiler, luma_lower);
    expect_equal(words(of_stream), put_right, "after the period");
    of_stream.run(profiler, luma);
    of_stream.forget();
    of_stream.run(profiler, luma_lower);
    expect_equal(words(of_stream), put_right, "after forget()");
}

INSTANTIATE_TEST_SUITE_P(OddSizes, EnginePassesTest,
                         testing::Values(PassCase{61, 47, 13}, PassCase{16, 16, 16},
                                         PassCase{131, 38, 37}, PassCase{311, 239, 21}));

class PermRows : public testing::TestWithParam<PermCosts> {};

TEST_P(PermRows, GivesTheSameSlabWhicheverWayItsLanesLie) {
    const bool given = GetParam() == PermCosts::given;
    const EglContext context;
    const ShaderLibrary library;
    const StereoLayout layout{53, 21};
    cv::RNG random(3);
    std::vector<std::uint32_t> left(layout.pixels()), right(layout.pixels());
    std::vector<unsigned char> mu(layout.pixels());
    for (std::size_t i = 0; i < layout.pixels(); ++i) {
        left[i] = random.next();
        right[i] = random.next();
        mu[i] = static_cast<unsigned char>(random.next() & 15U);
        if (i % static_cast<std::size_t>(layout.stride_px()) == 0) mu[i] = 0;
    }
    const auto left_buffer = Buffer::of<std::uint32_t>(left),
               right_buffer = Buffer::of<std::uint32_t>(right),
               mu_buffer = Buffer::of<unsigned char>(mu);
    std::vector<unsigned char> costs(layout.block_pixels() * 32);
    for (unsigned char& cost : costs) cost = static_cast<unsigned char>(random.uniform(0, 27));
    const auto cost_buffer = Buffer::of<unsigned char>(costs);
    std::vector<std::vector<std::uint32_t>> slabs;
    for (const int lanes : {0, 1}) {
        const Buffer volume(layout.block_pixels() * 16, GL_DYNAMIC_COPY);
        Program program = Program::compute(
            library, "perm_rows.comp",
            {{"LANE_MAPPING", std::to_string(lanes)}, {"GIVEN", given ? "1" : "0"}});
        program.use();
        if (given) program.set("plane", static_cast<int>(layout.block_pixels()));
        program.set("size", Eigen::Vector2i(layout.width_px, layout.height_px));
        program.set("stride", layout.stride_px());
        program.set("first_disparity", 16);
        (given ? cost_buffer : left_buffer).bind_storage(0);
        right_buffer.bind_storage(1);
        mu_buffer.bind_storage(2);
        const Buffer marks(layout.pixels() * 8, GL_DYNAMIC_COPY);
        volume.bind_storage(3);
        marks.bind_storage(4);
        program.dispatch_over(lanes == 1 ? 2 * layout.height_px : layout.height_px, 1);
        glMemoryBarrier(GL_ALL_BARRIER_BITS);
        std::vector<std::uint32_t>& slab = slabs.emplace_back(volume.bytes() / 4);
        volume.read(0, std::as_writable_bytes(std::span(slab)));
    }
    for (int y = 0; y < layout.height_px; ++y)
        for (int x = 0; x < layout.width_px; ++x)
            for (std::size_t i = 0; i < 4; ++i) {
                const std::size_t at = layout.block_at(x, y) * 4 + i;
                ASSERT_EQ(slabs[0][at], slabs[1][at]) << "word " << i << " of " << x << ", " << y;
            }
}

INSTANTIATE_TEST_SUITE_P(Costs, PermRows, testing::Values(PermCosts::found, PermCosts::given));

}  // namespace
}  // namespace vantage
