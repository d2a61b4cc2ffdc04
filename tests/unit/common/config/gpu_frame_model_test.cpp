#include "common/config/gpu_frame_model.h"

#include <fstream>
#include <regex>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/source_folder.h"

namespace vantage {
namespace {

constexpr GpuFrameModel model = {
    "board", "GPU 1", 2, 1, {{{"quality", 18, 1}, {"balanced", 8, 0.5}, {"fast", 0, 0.225}}}};

constexpr MatchedFrame frame_at(double rate_hz) { return {1000, 100, 80, rate_hz}; }

TEST(GpuFrameModel, CountsPixelsAndDisparities) {
    EXPECT_DOUBLE_EQ(model.frame_ms(model.presets[0], frame_at(30)), 10.0);
    EXPECT_DOUBLE_EQ(model.frame_ms(model.presets[2], frame_at(30)), 2.0);
}

TEST(GpuFrameModel, CountsTheReductionOfLargerPictures) {
    MatchedFrame frame = frame_at(30);
    frame.colour_width_px = 2000;
    frame.colour_height_px = 200;
    // 300 000 more pixels are rectified, and 400 000 are reduced to 100 000.
    EXPECT_DOUBLE_EQ(model.frame_ms(model.presets[0], frame), 10.0 + 0.6 + 0.5);
    EXPECT_THAT(model.fit_text(frame), testing::HasSubstr("1000x100, reduced from 2000x200 with"));
    EXPECT_EQ(model.fit_json(frame)["colour_width_px"], 2000);
}

TEST(GpuFrameModel, ChoosesTheBestPresetWithinTwoThirdsOfAPeriod) {
    const auto best = [](double rate_hz) {
        const GpuFrameModel::Preset* preset = model.fit(frame_at(rate_hz)).best;
        return std::string(preset ? preset->name : "none");
    };
    EXPECT_EQ(best(66), "quality");
    EXPECT_EQ(best(67), "balanced");
    EXPECT_EQ(best(134), "fast");
    EXPECT_EQ(best(334), "none");
}

TEST(GpuFrameModel, SaysWhatFits) {
    EXPECT_THAT(
        model.fit_text(frame_at(66)),
        testing::AllOf(testing::HasSubstr("1000x100 with 80 disparities at 66 Hz on the board"),
                       testing::HasSubstr("'quality' may fit"),
                       testing::HasSubstr("quality 10.0, balanced 5.0, fast 2.0")));
    EXPECT_THAT(model.fit_text(frame_at(1000)), testing::HasSubstr("no preset fits"));
}

TEST(GpuFrameModel, GivesMachinesTheSame) {
    const nlohmann::json fit = model.fit_json(frame_at(67));
    EXPECT_EQ(fit["board"], "board");
    EXPECT_EQ(fit["width_px"], 1000);
    EXPECT_EQ(fit["disparities"], 80);
    EXPECT_EQ(fit["preset"], "balanced");
    EXPECT_NEAR(fit["lower_bounds_ms"]["fast"].get<double>(), 2.0, 1e-9);
    EXPECT_FALSE(fit.contains("colour_width_px"));
    EXPECT_TRUE(model.fit_json(frame_at(1000))["preset"].is_null());
}

TEST(GpuFrameModel, KnowsBothRaspberryPisByTheirRenderer) {
    ASSERT_TRUE(GpuFrameModel::of("V3D 7.1.7.0"));
    EXPECT_STREQ(GpuFrameModel::of("V3D 7.1.7.0")->board, "Raspberry Pi 5");
    ASSERT_TRUE(GpuFrameModel::of("V3D 4.2.14.0"));
    EXPECT_STREQ(GpuFrameModel::of("V3D 4.2.14.0")->board, "Raspberry Pi 4");
    EXPECT_FALSE(GpuFrameModel::of("llvmpipe (LLVM 19.1.7, 128 bits)"));
    for (const GpuFrameModel& pi : GpuFrameModel::all()) {
        const MatchedFrame frame{640, 400, 64, 30};
        const double best = pi.frame_ms(pi.presets[0], frame);
        const double worst = pi.frame_ms(pi.presets[2], frame);
        EXPECT_GT(best, worst) << "the presets come in the order of their quality";
        EXPECT_GT(worst, 1);
    }
}

/// The lower bounds of docs/results/v3d.md, which tools/v3d.sh writes.
TEST(GpuFrameModel, AgreesWithThePageOfBounds) {
    const std::regex row(
        R"(\| (Raspberry Pi \d) \(\S+ \S+\) \| (\w+) \(\w+\) (\d+)x(\d+)x(\d+)(?: of (\d+)x(\d+))? \| ([\d.]+) \|.*)");
    std::ifstream page(source_folder() / "docs/results/v3d.md");
    int rows = 0;
    for (std::string line; std::getline(page, line);) {
        std::smatch cells;
        if (!std::regex_match(line, cells, row)) continue;
        ++rows;
        const auto number = [&](int cell) {
            return cells[cell].matched ? std::stoi(cells[cell]) : 0;
        };
        const MatchedFrame frame{.width_px = number(3),
                                 .height_px = number(4),
                                 .disparities = number(5),
                                 .rate_hz = 30,
                                 .colour_width_px = number(6),
                                 .colour_height_px = number(7)};
        for (const GpuFrameModel& pi : GpuFrameModel::all())
            for (const GpuFrameModel::Preset& preset : pi.presets)
                if (cells[1] == pi.board && cells[2] == preset.name) {
                    EXPECT_NEAR(pi.frame_ms(preset, frame) / std::stod(cells[8]), 1, 0.05) << line;
                }
    }
    EXPECT_GE(rows, 10);
}

}  // namespace
}  // namespace vantage
