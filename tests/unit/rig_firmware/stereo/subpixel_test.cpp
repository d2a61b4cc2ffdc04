#include <gtest/gtest.h>

#include "tests/bench/stereo/stereo_measures.h"

namespace vantage {
namespace {

class SubpixelTest : public testing::TestWithParam<std::uint64_t> {
  protected:
    EglContext context_;
    ShaderLibrary library_;
};

TEST_P(SubpixelTest, IsWithinASeventhOfAPixelOnSlantedPlanesUnderSensorNoise) {
    // From the side that sets keep clear for rigs.
    VirtualStage stage(library_, GetParam());
    const FilmedPair pair = StageFilm(stage, {.azimuth_rad = 0.2 * static_cast<double>(GetParam()),
                                              .width_px = 449,
                                              .height_px = 337})
                                .at(std::chrono::seconds(1), {.sigma = 1});
    constexpr int disparities = 48;
    for (const MatchPreset preset :
         {MatchPreset::quality, MatchPreset::balanced, MatchPreset::fast}) {
        const auto matcher = make_matcher(
            default_matcher(preset), library_,
            {.width_px = 449, .height_px = 337, .disparities = disparities, .preset = preset});
        const SubpixelError error =
            subpixel_error_on_slants(matched(*matcher, pair), pair, disparities);
        EXPECT_GT(error.judged, 20000);
        EXPECT_GE(error.inliers, 0.97 * error.judged);
        EXPECT_LE(error.rms_px, 0.15) << default_matcher(preset);
        RecordProperty(default_matcher(preset), std::to_string(error.rms_px));
    }
}

// Sets 3 and 4 have a pale floor: hardly anything that lies slanted has texture there.
INSTANTIATE_TEST_SUITE_P(Sets, SubpixelTest, testing::Values(0, 1, 2, 5, 6));

}  // namespace
}  // namespace vantage
