#include <fstream>
#include <memory>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "common/image/image_file.h"
#include "common/sync/sync_file.h"
#include "tests/support/child_program.h"
#include "tests/support/data_folder.h"
#include "tests/support/free_ports.h"

namespace vantage {
namespace {

using testing::HasSubstr;

/// Rigs of 10 pulses a second that film a bar and a still picture.
class SyncCommand : public testing::Test {
  protected:
    SyncCommand() {
        write_colour_image(file("still.png"), ColourImage(240, 320, cv::Vec4b(80, 90, 70, 255)));
        std::ofstream stage(file("stage.toml"));
        stage << "version = 1\nrate_hz = 10\n";
        for (const auto& [name, port] : {std::pair("A", ports_.first), {"B", ports_.second}})
            stage << "[[rigs]]\nname = \"" << name << "\"\nendpoint = \"" << endpoint(port)
                  << "\"\n";
    }

    std::string file(const std::string& name) const { return (folder_.path() / name).string(); }
    static std::string endpoint(int port) { return fmt::format("tcp://127.0.0.1:{}", port); }

    std::string config(const std::string& rig, int port, const std::string& source, int left_us,
                       int right_us) const {
        const std::string path = file(rig + ".toml");
        std::ofstream(path) << "version = 1\nname = \"" << rig << "\"\ncalibration = \"none\"\n"
                            << "[source]\nrate_hz = 10\n"
                            << source << "exposure_us = 4000\n[virtual_rig]\nbar_leds = 12\n"
                            << "left_skew_us = " << left_us << "\nright_skew_us = " << right_us
                            << "\n[stream]\nbind = \"" << endpoint(port) << "\"\n";
        return path;
    }
    std::string still_rig() const {
        const std::string still = "kind = \"files\"\nleft = \"" + file("still.png") +
                                  "\"\nright = \"" + file("still.png") + "\"\n";
        return config("A", ports_.first, still, 0, 8400);
    }

    TemporaryFolder folder_;
    std::pair<int, int> ports_ = two_free_ports();
};

TEST_F(SyncCommand, finds_the_skews_of_running_rigs_and_keeps_them_beside_the_stage) {
    const std::string b = config("B", ports_.second,
                                 "kind = \"virtual\"\nwidth_px = 320\nheight_px = 240\n"
                                 "noise_sigma = 2.0\n",
                                 100'300, 100'310);
    std::vector<std::unique_ptr<ChildProgram>> rigs;
    for (const std::string& path : {still_rig(), b})
        rigs.push_back(std::make_unique<ChildProgram>(
            VANTAGE_RIG_PROGRAM, std::vector<std::string>{"run", "--config", path},
            folder_.path()));
    const ProgramResult result = run_to_end(
        VANTAGE_CALIB, {"sync", "--live", file("stage.toml"), "--views", "16", "--json"});
    EXPECT_EQ(result.status, 1) << result.err << rigs[0]->err() << rigs[1]->err();
    EXPECT_THAT(result.err, HasSubstr("the stage is not in step: A right exposes 8."));
    EXPECT_THAT(result.err, HasSubstr("B left is 1 frame behind (+100."));
    const SyncRecord record = load_sync(file("stage.sync.yaml"));
    ASSERT_EQ(record.sensors.size(), 4u) << result.err;
    const double truth_ms[] = {0, 8.4, 100.3, 100.31};
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_NEAR(record.sensors[i].skew_ms, truth_ms[i], 0.1) << i;
        EXPECT_NEAR(record.sensors[i].exposure_ms, 4, 0.2) << i;
    }
    EXPECT_EQ(nlohmann::json::parse(result.out).at("sensors")[2].at("pulses_apart"), 1);
}

TEST_F(SyncCommand, reads_folders_of_numbered_pictures) {
    const ProgramResult captured = run_to_end(
        VANTAGE_RIG_PROGRAM,
        {"capture", "--config", still_rig(), "--every", "1", "--count", "14", "-o", file("A")});
    ASSERT_EQ(captured.status, 0) << captured.err;
    const std::vector<std::string> sync = {
        "sync", "--stage", file("stage.toml"), "--rig", "A=" + file("A"), "--limit-ms", "10"};
    const ProgramResult result = run_to_end(VANTAGE_CALIB, sync);
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_THAT(result.out, HasSubstr("A: right +8."));

    // Another bar is asked for than the pictures show; what is kept stays.
    std::vector<std::string> another = sync;
    another.insert(another.end(), {"--step-us", "90"});
    const ProgramResult refused = run_to_end(VANTAGE_CALIB, another);
    EXPECT_EQ(refused.status, 1);
    EXPECT_THAT(refused.err, HasSubstr("A left: a bar is seen that does not count 12 LEDs in "
                                       "steps of 0.09 ms"));
    EXPECT_NEAR(load_sync(file("stage.sync.yaml")).sensors[1].skew_ms, 8.4, 0.1);
}

}  // namespace
}  // namespace vantage
