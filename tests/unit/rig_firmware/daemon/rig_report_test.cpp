#include "rig_firmware/daemon/rig_report.h"

#include <array>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "common/base/library_log.h"
#include "common/base/refused_inputs.h"
#include "tests/support/data_folder.h"

namespace vantage {
namespace {

using testing::HasSubstr;

TEST(RigReport, HasTheLastRefusedInputAndTheStepsOfTheClock) {
    const TemporaryFolder folder;
    RigConfig config;
    config.name = "north";
    config.file = folder.path() / "rig.toml";
    std::ofstream(config.file) << "version = 1\nname = \"north\"\n# password: battery-Staple\n";
    std::array<std::byte, 2 * max_refused_bytes> input{};
    input[0] = std::byte{0xab};
    note_refused_input("report example", input, "the first");
    note_refused_input("report example", input, "longer than its header states");
    LibraryLog library("libreport", LogLevel::debug);
    library.note("one");
    library.note("two");
    // The probe has tests of its own.
    const std::atomic<bool> stopping{true};
    const std::string text =
        rig_report(config, {{"GPU: none"}, {"04:05:06 set by +3600000 ms"}}, stopping);
    EXPECT_EQ(text.find("battery-Staple"), std::string::npos);
    const auto report = nlohmann::json::parse(text);
    EXPECT_EQ(report.at("rig"), "north");
    EXPECT_EQ(report.at("clock_steps").at(0), "04:05:06 set by +3600000 ms");
    EXPECT_EQ(report.at("start").at(0), "GPU: none");
    EXPECT_EQ(report.at("library_messages").at("libreport"), 2);
    EXPECT_THAT(report.at("addresses").dump(), HasSubstr("127.0.0.1"));
    EXPECT_THAT(report.at("probe").get<std::string>(), HasSubstr("the daemon ends"));
    int found = 0;
    for (const auto& refused : report.at("refused_inputs")) {
        if (refused.at("decoder") != "report example") continue;
        ++found;
        EXPECT_EQ(refused.at("reason"), "longer than its header states");
        EXPECT_EQ(refused.at("count"), 2);
        EXPECT_EQ(refused.at("bytes"), 2 * max_refused_bytes);
        const std::string hex = refused.at("hex");
        EXPECT_EQ(hex.size(), 2 * max_refused_bytes) << "the first 256 bytes";
        EXPECT_TRUE(hex.starts_with("ab00"));
    }
    EXPECT_EQ(found, 1);
}

}  // namespace
}  // namespace vantage
