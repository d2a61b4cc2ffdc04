#include <csignal>
#include <filesystem>
#include <fstream>
#include <random>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "common/image/image_file.h"
#include "host_app/commands/demo/demo_stage.h"
#include "tests/support/child_program.h"
#include "tests/support/data_folder.h"
#include "tests/support/eventually.h"

namespace vantage {
namespace {

/// Returns whether a rig with a key answers there.
bool serves(const std::string& stage) {
    return run_to_end(VANTAGE_PROGRAM, {"rigs", "status", "--stage", stage, "--wait", "1"})
               .status == 0;
}

/// Kills the vantage-rig that has this argument. Returns whether there was one.
bool kill_program_with(const std::string& argument) {
    for (const auto& process : std::filesystem::directory_iterator("/proc")) {
        std::ifstream file(process.path() / "cmdline");
        std::string name, word;
        std::getline(file, name, '\0');
        if (!name.ends_with("vantage-rig")) continue;
        while (std::getline(file, word, '\0'))
            if (word == argument) return ::kill(std::stoi(process.path().filename()), SIGKILL) == 0;
    }
    return false;
}

class Demo : public testing::Test {
  protected:
    Demo() {
        // A textured wall with a disparity of 8 px.
        std::mt19937 random(1);
        ColourImage right(96, 128);
        for (auto& texel : right)
            texel = cv::Vec4b(static_cast<unsigned char>(random()),
                              static_cast<unsigned char>(random()),
                              static_cast<unsigned char>(random()), 255);
        ColourImage left = right.clone();
        right.colRange(0, 120).copyTo(left.colRange(8, 128));
        write_colour_image(file("left.png"), left);
        write_colour_image(file("right.png"), right);
    }
    std::string file(const std::string& name) const { return (folder_.path() / name).string(); }

    TemporaryFolder folder_;
};

TEST(DemoSize, IsTheLargestThatLeavesTheHostHalfOfTheGpu) {
    std::vector<int> tried;
    const auto size_where_a_megapixel_takes = [&](double ms) {
        tried.clear();
        return gpu_demo_size(4, [&](const DemoSize& size) {
            tried.push_back(size.rig[0]);
            return ms * size.rig[0] * size.rig[1] * 1e-6;
        });
    };
    EXPECT_EQ(size_where_a_megapixel_takes(7).rig[0], 960) << "100 pairs a second of 4.8 ms";
    EXPECT_EQ(tried, std::vector<int>{960});
    EXPECT_EQ(size_where_a_megapixel_takes(15).rig[0], 640);
    EXPECT_EQ(size_where_a_megapixel_takes(15).rate_hz, 25);
    const DemoSize slowest = size_where_a_megapixel_takes(1000);
    EXPECT_LT(slowest.rate_hz, 25);
    EXPECT_FALSE(slowest.is_software);
    EXPECT_EQ(tried, (std::vector<int>{960, 640})) << "there is nothing to choose after them";
}

/// The system offers some free port twice among so many.
TEST(DemoStage, GivesEveryRigAPortOfItsOwn) {
    const TemporaryFolder folder;
    DemoStage stage(folder.path(), {});
    constexpr int rigs = 300;
    std::set<std::string> binds;
    for (int i = 0; i < rigs; ++i) {
        const std::string name = "rig" + std::to_string(i);
        stage.add_rig(name, {});
        const toml::table written = toml::parse_file(stage.rig_file(name).string());
        binds.insert(written["stream"]["bind"].value_or(std::string()));
    }
    EXPECT_EQ(binds.size(), std::size_t{rigs});
}

TEST(DemoSize, IsSlowerOnASlowSoftwareRenderer) {
    EXPECT_EQ(software_rate_hz(4, 5), software_demo_size().rate_hz);
    EXPECT_EQ(software_rate_hz(4, 15), 3.5) << "3.7 of them take 220 ms";
    EXPECT_EQ(software_rate_hz(4, 20), 2.5);
    EXPECT_EQ(software_rate_hz(4, 500), 2) << "the fewest";
}

TEST_F(Demo, PlaysAPairAndWritesTheFlight) {
    // A file of an earlier demo.
    std::filesystem::create_directory(file("out"));
    write_colour_image(file("out/contact_sheet.png"), ColourImage(1, 1));
    const ProgramResult result = run_to_end(
        VANTAGE_PROGRAM, {"demo", "--files", file("left.png"), file("right.png"), "--headless",
                          "--seconds", "2", "--folder", file("out"), "--json"});
    ASSERT_EQ(result.status, 0) << result.err;
    const nlohmann::json summary = nlohmann::json::parse(result.out);
    EXPECT_GE(summary["new_pictures"], 5);
    EXPECT_EQ(summary["signal"], "live");
    EXPECT_TRUE(std::filesystem::exists(file("out/flight.mkv")));
    EXPECT_GT(read_colour_image(file("out/contact_sheet.png")).cols, 1);
    EXPECT_NE(result.err.find("this flight replaces contact_sheet.png; "), std::string::npos)
        << result.err;
}

TEST_F(Demo, RigsEndWithTheDemo) {
    ChildProgram demo(VANTAGE_PROGRAM,
                      {"demo", "--files", file("left.png"), file("right.png"), "--rigs-only",
                       "--folder", file("out")},
                      folder_.path());
    ASSERT_TRUE(eventually([&] { return !demo.out().empty(); })) << demo.err();
    ASSERT_TRUE(demo.out().starts_with("ready: ")) << demo.err();
    const std::string stage = file("out/demo/stage.toml");
    bool served = false;
    for (int tries = 0; tries < 60 && !served; ++tries) served = serves(stage);
    EXPECT_TRUE(served) << demo.err();
    demo.send_signal(SIGKILL);
    (void)demo.wait();
    bool is_gone = false;
    for (int tries = 0; tries < 20 && !is_gone; ++tries) is_gone = !serves(stage);
    EXPECT_TRUE(is_gone);
}

TEST_F(Demo, GoesOnWithRigsAloneWhenOneIsKilled) {
    ChildProgram demo(VANTAGE_PROGRAM,
                      {"demo", "--files", file("left.png"), file("right.png"), "--rigs-only",
                       "--folder", file("out")},
                      folder_.path());
    ASSERT_TRUE(eventually([&] { return demo.out().starts_with("ready: "); })) << demo.err();
    const std::string stage = file("out/demo/stage.toml");
    ASSERT_TRUE(eventually([&] { return serves(stage); })) << demo.err();
    ASSERT_TRUE(kill_program_with(file("out/demo/pair.toml")));
    ASSERT_TRUE(eventually([&] { return !serves(stage); }));
    EXPECT_FALSE(demo.ended()) << demo.err();
    demo.send_signal(SIGINT);
    EXPECT_EQ(demo.wait().status, 130);
}

TEST_F(Demo, ReportsFaultsOfAPair) {
    const ProgramResult missing =
        run_to_end(VANTAGE_PROGRAM, {"demo", "--files", file("left.png"), file("none.png"),
                                     "--headless", "--folder", file("out")});
    EXPECT_EQ(missing.status, 1);
    EXPECT_EQ(missing.err.find("vantage-rig"), std::string::npos)
        << "one sentence: " << missing.err;
    EXPECT_NE(missing.err.find("none.png"), std::string::npos) << missing.err;
    const ProgramResult unmeasured =
        run_to_end(VANTAGE_PROGRAM, {"demo", "--rig", file("none.yaml"), file("left.png"),
                                     file("right.png"), "--headless", "--folder", file("out/new")});
    EXPECT_EQ(unmeasured.status, 1);
    EXPECT_EQ(unmeasured.err.find("vantage: error: "), 0u) << unmeasured.err;
    EXPECT_NE(unmeasured.err.find("none.yaml"), std::string::npos) << unmeasured.err;
    EXPECT_FALSE(std::filesystem::exists(file("out/new"))) << "nothing was begun";
    const ProgramResult alone =
        run_to_end(VANTAGE_PROGRAM, {"demo", "--disparities", "64", "--folder", file("out")});
    EXPECT_EQ(alone.status, 2);
    EXPECT_NE(alone.err.find("--rig"), std::string::npos) << alone.err;
}

}  // namespace
}  // namespace vantage
