#include "rig_firmware/stereo/disparity/smooth_pass.h"

#include <cmath>

#include "tests/references/stereo/smooth_reference.h"
#include "tests/unit/rig_firmware/stereo/engine_buffers.h"

namespace vantage {
namespace {

using SmoothPassTest = EnginePassTest;

/// A slant that steps by ten pixels in the middle, with noise of up to `noise` steps, every
/// seventh pixel or so unknown.
DisparityImage slant_with_a_step(const StereoLayout& layout, int noise, bool with_unknown) {
    cv::RNG random(2);
    DisparityImage disparity(layout.height_px, layout.width_px);
    for (int y = 0; y < disparity.rows; ++y)
        for (int x = 0; x < disparity.cols; ++x) {
            const int step = x < disparity.cols / 2 ? 0 : 320;
            const int value = 100 + 3 * x + 2 * y + step + random.uniform(-noise, noise + 1);
            const bool is_unknown = with_unknown && random.uniform(0, 7) == 0;
            disparity(y, x) = static_cast<unsigned short>(is_unknown ? 0 : value);
        }
    return disparity;
}

DisparityImage smoothed_by_pass(const ShaderLibrary& library, const StereoLayout& layout,
                                const DisparityImage& disparity, cv::Mat1i& confidence,
                                int most_step = disparity_steps_per_px) {
    std::vector<std::uint32_t> words(layout.pixels(), 0xabcdef01U);
    for (int y = 0; y < disparity.rows; ++y)
        for (int x = 0; x < disparity.cols; ++x)
            words[static_cast<std::size_t>(y * layout.stride_px() + x)] =
                disparity(y, x) | static_cast<std::uint32_t>((x + y) & 255) << 16;
    const auto buffer = Buffer::of<std::uint32_t>(words);
    PassProfiler profiler;
    SmoothPass(library, layout, most_step).run(profiler, buffer);
    const cv::Mat1i result = channel_of(buffer, layout, 1, 0);
    confidence = upper_half(result);
    DisparityImage smoothed;
    lower_half(result).convertTo(smoothed, CV_16U);
    return smoothed;
}

TEST_P(SmoothPassTest, AgreesWithItsCpuFormBitForBitAndLeavesUnknownAndConfidence) {
    const DisparityImage disparity = slant_with_a_step(layout_, 24, true);
    cv::Mat1i confidence;
    const DisparityImage found = smoothed_by_pass(library_, layout_, disparity, confidence);
    expect_equal(as_int(found), as_int(smoothed_where_near(disparity)), "smoothed");
    cv::Mat1i same;
    expect_equal(as_int(smoothed_by_pass(library_, layout_, disparity, same, 11)),
                 as_int(smoothed_where_near(disparity, 11)), "smoothed where nearer");
    for (int y = 0; y < found.rows; ++y)
        for (int x = 0; x < found.cols; ++x) {
            ASSERT_EQ(found(y, x) == 0, disparity(y, x) == 0) << x << ", " << y;
            ASSERT_EQ(confidence(y, x), (x + y) & 255) << x << ", " << y;
        }
}

TEST_P(SmoothPassTest, LeavesASlantAndItsEdgeAsTheyAreAndTakesNoiseOut) {
    const DisparityImage exact = slant_with_a_step(layout_, 0, false);
    expect_equal(as_int(smoothed_where_near(exact)), as_int(exact), "slant");
    const DisparityImage noisy = slant_with_a_step(layout_, 8, false);
    const double before = cv::norm(noisy, exact, cv::NORM_L2),
                 after = cv::norm(smoothed_where_near(noisy), exact, cv::NORM_L2);
    EXPECT_LT(after, 0.6 * before);
}

INSTANTIATE_TEST_SUITE_P(OddSizes, SmoothPassTest,
                         testing::Values(PassCase{61, 47, 1}, PassCase{16, 16, 1},
                                         PassCase{131, 38, 1}, PassCase{311, 239, 1}));

}  // namespace
}  // namespace vantage
