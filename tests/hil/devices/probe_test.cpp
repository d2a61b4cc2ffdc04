#include <fstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/child_program.h"
#include "tests/support/data_folder.h"

namespace vantage {
namespace {

using testing::HasSubstr;
using testing::Not;

/// `vantage-rig` as a user without a group that has devices.
ProgramResult run_as_nobody(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(),
                     {"--reuid=nobody", "--regid=nogroup", "--clear-groups", VANTAGE_RIG_PROGRAM});
    return run_to_end("/usr/bin/setpriv", arguments);
}

TEST(Probe, ListsCamerasLinesAndTheirConsumers) {
    const ProgramResult people = run_to_end(VANTAGE_RIG_PROGRAM, {"probe"});
    EXPECT_EQ(people.status, 0) << people.err;
    std::printf("%s\n", people.out.c_str());
    EXPECT_THAT(people.out, HasSubstr("HELD"));
    EXPECT_THAT(people.out, HasSubstr("('vivid'): gain is automatic"));

    const ProgramResult result = run_to_end(VANTAGE_RIG_PROGRAM, {"probe", "--json"});
    ASSERT_EQ(result.status, 0) << result.err;
    const nlohmann::json json = nlohmann::json::parse(result.out);
    std::vector<std::string> nodes;
    for (const auto& camera : json["cameras"]["v4l2"]) {
        nodes.push_back(camera["path"]);
        EXPECT_FALSE(camera["formats"].empty()) << camera;
    }
    for (const char* node : {"/dev/video10", "/dev/video12", "/dev/video14"})
        EXPECT_THAT(nodes, testing::Contains(std::string(node)));
    EXPECT_THAT(nodes, Not(testing::Contains("/dev/video11"))) << "an output is no camera";
    ASSERT_FALSE(json["gpio"].empty());
    for (const auto& chip : json["gpio"]) {
        if (chip["label"] != "vantage-test") continue;
        ASSERT_EQ(chip["lines"].size(), 8u);
        EXPECT_EQ(chip["lines"][0]["name"], "TRIGGER");
        EXPECT_EQ(chip["lines"][0]["is_used"], false);
        EXPECT_EQ(chip["lines"][2]["consumer"], "somebody-else");
        EXPECT_EQ(chip["lines"][2]["direction"], "output");
    }
    EXPECT_EQ(json["clocks"]["scheduling"]["may_have_realtime_priority"], true);
    EXPECT_THAT(json["unfit"].dump(), Not(HasSubstr("real-time priority")));
}

TEST(Probe, SaysWhatAUserWithoutRightsMissesAndTheMend) {
    const ProgramResult result = run_as_nobody({"probe"});
    EXPECT_EQ(result.status, 0) << result.err;
    const std::string unfit = result.out.substr(result.out.find("What is unfit"));
    std::printf("%s\n", unfit.c_str());
    EXPECT_THAT(unfit, HasSubstr("/dev/video14 may not be opened by this user: put the user into "
                                 "the group 'video', or install the udev rules of Vantage "
                                 "(60-vantage-camera.rules)"));
    EXPECT_THAT(unfit, HasSubstr("libcamera shows no camera"));
    EXPECT_THAT(unfit, HasSubstr("60-vantage-gpio.rules"));
    EXPECT_THAT(unfit, HasSubstr("no real-time priority"));
}

TEST(Probe, ARunWithoutRightsNamesTheRuleToo) {
    const TemporaryFolder folder;
    std::filesystem::permissions(folder.path(), std::filesystem::perms::all);
    const std::string config = (folder.path() / "rig.toml").string();
    const auto start = [&](const std::string& kind, const std::string& device) {
        std::ofstream(config) << "version = 1\nname = \"rig\"\ncalibration = \"none\"\n[source]\n"
                              << "kind = \"" << kind << "\"\nwidth_px = 160\nheight_px = 180\n"
                              << "left_device = \"" << device << "\"\nside_by_side = true\n";
        return run_as_nobody({"run", "--config", config});
    };
    for (const auto& [kind, device] :
         {std::pair("v4l2", "/dev/video14"), std::pair("libcamera", "*1209:ca01")}) {
        const ProgramResult result = start(kind, device);
        EXPECT_EQ(result.status, 1) << kind;
        EXPECT_THAT(result.err, HasSubstr("60-vantage-camera.rules")) << kind;
    }
}

}  // namespace
}  // namespace vantage
