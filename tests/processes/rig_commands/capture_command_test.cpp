#include <fstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "common/image/image_file.h"
#include "tests/support/child_program.h"
#include "tests/support/data_folder.h"

namespace vantage {
namespace {

TEST(CaptureCommand, KeepsPairsNumberedByPulseAsTheSensorsSeeThem) {
    const TemporaryFolder folder;
    const std::string config = folder.path() / "rig.toml", out = folder.path() / "pairs";
    std::ofstream(config) << "version = 1\nname = \"test\"\n[source]\nkind = \"virtual\"\n"
                             "rate_hz = 20\nwidth_px = 61\nheight_px = 47\n";
    const ProgramResult result = run_to_end(
        VANTAGE_RIG,
        {"capture", "--config", config, "--every", "4", "--count", "2", "-o", out, "--json"});
    ASSERT_EQ(result.status, 0) << result.err;
    const auto json = nlohmann::json::parse(result.out);
    EXPECT_EQ(json.at("pairs"), 2);
    EXPECT_EQ(json.at("synchronized"), true);
    for (const auto& index : json.at("indices")) {
        EXPECT_EQ(index.get<std::uint64_t>() % 4, 0u);
        for (const char* side : {"left_", "right_"}) {
            const ColourImage picture = read_colour_image(
                out + "/" + side + std::to_string(index.get<std::uint64_t>()) + ".png");
            EXPECT_EQ(picture.size(), cv::Size(61, 47));
        }
    }
}

TEST(CaptureCommand, SaysWhatIsWrongWithAConfigurationThatIsMissing) {
    const ProgramResult result =
        run_to_end(VANTAGE_RIG, {"capture", "--config", "/none.toml", "-o", "/tmp"});
    EXPECT_EQ(result.status, 1);
    EXPECT_EQ(result.out, "");
    EXPECT_NE(result.err.find("/none.toml"), std::string::npos) << result.err;
}

}  // namespace
}  // namespace vantage
