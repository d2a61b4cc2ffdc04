#include "common/config/gpu_frame_model.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace vantage {
namespace {

constexpr GpuFrameModel model = {
    "board", "GPU 1", {{"quality", 20, 1}, {"balanced", 10, 0.5}, {"fast", 0, 0.25}}};

TEST(GpuFrameModel, CountsPixelsAndDisparities) {
    EXPECT_DOUBLE_EQ(GpuFrameModel::frame_ms(model.presets[0], 1000, 100, 80), 10.0);
    EXPECT_DOUBLE_EQ(GpuFrameModel::frame_ms(model.presets[2], 1000, 100, 80), 2.0);
}

TEST(GpuFrameModel, ChoosesTheBestPresetWithinTwoThirdsOfAPeriod) {
    const auto best = [](double rate_hz) {
        const GpuFrameModel::Preset* preset = model.best_for(1000, 100, 80, rate_hz);
        return std::string(preset ? preset->name : "none");
    };
    EXPECT_EQ(best(66), "quality");
    EXPECT_EQ(best(67), "balanced");
    EXPECT_EQ(best(134), "fast");
    EXPECT_EQ(best(334), "none");
}

TEST(GpuFrameModel, SaysWhatFits) {
    EXPECT_THAT(
        model.fit_text(1000, 100, 80, 66),
        testing::AllOf(testing::HasSubstr("1000x100 with 80 disparities at 66 Hz on the board"),
                       testing::HasSubstr("'quality' may fit"),
                       testing::HasSubstr("quality 10.0, balanced 5.0, fast 2.0")));
    EXPECT_THAT(model.fit_text(1000, 100, 80, 1000), testing::HasSubstr("no preset fits"));
}

TEST(GpuFrameModel, KnowsBothRaspberryPisByTheirRenderer) {
    ASSERT_TRUE(GpuFrameModel::of("V3D 7.1.7.0"));
    EXPECT_STREQ(GpuFrameModel::of("V3D 7.1.7.0")->board, "Raspberry Pi 5");
    ASSERT_TRUE(GpuFrameModel::of("V3D 4.2.14.0"));
    EXPECT_STREQ(GpuFrameModel::of("V3D 4.2.14.0")->board, "Raspberry Pi 4");
    EXPECT_FALSE(GpuFrameModel::of("llvmpipe (LLVM 19.1.7, 128 bits)"));
    for (const GpuFrameModel& pi : GpuFrameModel::all()) {
        const double best = GpuFrameModel::frame_ms(pi.presets[0], 640, 400, 64);
        const double worst = GpuFrameModel::frame_ms(pi.presets[2], 640, 400, 64);
        EXPECT_GT(best, worst) << "the presets come in the order of their quality";
        EXPECT_GT(worst, 1);
    }
}

}  // namespace
}  // namespace vantage
