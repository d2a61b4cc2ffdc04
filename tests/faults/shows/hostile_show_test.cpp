// A show stays whole beside a rig that attacks it.
#include <csignal>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "common/wire/curve_keys.h"
#include "tests/faults/hostile_rig.h"
#include "tests/support/child_program.h"
#include "tests/support/data_folder.h"
#include "tests/support/eventually.h"
#include "tests/support/free_ports.h"
#include "tests/support/tiny_rig.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;

/// The most memory that a child of this process with this name has had so far.
double most_resident_mb(const std::string& name) {
    for (const auto& process : std::filesystem::directory_iterator("/proc")) {
        std::ifstream status(process.path() / "status");
        std::string key, comm;
        long parent = 0;
        double most_kb = 0;
        while (status >> key) {
            if (key == "Name:") status >> comm;
            if (key == "PPid:") status >> parent;
            if (key == "VmHWM:") status >> most_kb;
        }
        if (comm == name && parent == ::getpid()) return 1e-3 * most_kb;
    }
    return 0;
}

class HostileShow : public testing::Test {
  protected:
    std::string file(const std::string& name) const { return (folder_.path() / name).string(); }

    std::unique_ptr<ChildProgram> start_rig(const std::string& name, int azimuth_deg, int port) {
        return start_tiny_rig(VANTAGE_RIG_PROGRAM, folder_.path(), name, azimuth_deg,
                              endpoint(port));
    }
    static std::string endpoint(int port) { return fmt::format("tcp://127.0.0.1:{}", port); }
    static std::string entry(const std::string& name, const std::string& endpoint,
                             const std::string& key = "") {
        return fmt::format("[[rigs]]\nname = \"{}\"\nendpoint = \"{}\"\n{}", name, endpoint,
                           key.empty() ? "" : "public_key = \"" + key + "\"\n");
    }

    TemporaryFolder folder_;
    std::pair<int, int> ports_ = two_free_ports();
};

TEST_F(HostileShow, HoldsItsTicksAndLosesNoFrameOfAnotherRig) {
    write_key_file(file("host.key"), generate_curve_keys());
    HostileRig hostile("hostile", 200ms, 7);
    const auto left = start_rig("left", -12, ports_.first),
               right = start_rig("right", 12, ports_.second);
    std::ofstream(file("stage.toml"))
        << "version = 1\nrate_hz = 5\nlatency_budget_ms = 2000\nkey_file = \"host.key\"\n"
        << entry("left", endpoint(ports_.first)) << entry("right", endpoint(ports_.second))
        << entry("hostile", hostile.endpoint(), hostile.public_key())
        << "[view]\nwidth_px = 96\nheight_px = 64\n";
    ChildProgram host(VANTAGE_PROGRAM,
                      {"live", "--stage", file("stage.toml"), "--headless", "--json", "--wait",
                       "60", "--rate", "10", "--seconds", "600", "--past-mb", "64"},
                      folder_.path());
    host.wait_for(" frames, ");
    const std::uint64_t before = hostile.sent();
    constexpr std::uint64_t messages = 5000;
    ASSERT_TRUE(eventually([&] { return hostile.sent() > before + messages || host.ended(); }))
        << host.err();
    const double most_mb = most_resident_mb("vantage");
    host.send_signal(SIGINT);
    const ProgramResult result = host.wait();
    ASSERT_EQ(result.status, 130) << result.err;
    const nlohmann::json summary = nlohmann::json::parse(result.out);
    EXPECT_GE(summary["pictures"], 20);
    EXPECT_LE(summary["missed_ticks"].get<double>(), 1 + 0.02 * summary["pictures"].get<double>())
        << summary["tick_late_ms"];
    EXPECT_GE(summary["new_pictures"], 3) << result.err;
    for (const char* name : {"left", "right"}) {
        const nlohmann::json rig = summary["rigs"][name == std::string("left") ? 0 : 1];
        EXPECT_EQ(rig["name"], name);
        EXPECT_EQ(rig["state"], "connected");
        EXPECT_EQ(rig["outages"]["count"], 0);
        EXPECT_EQ(rig["link"]["lost"], 0);
        for (const char* what : {"undecodable", "duplicate", "unsynchronized"})
            EXPECT_EQ(rig["host"][what], 0) << what << ": " << rig;
        // The first one may come while the hostile rig is alone, before this one is connected.
        EXPECT_LE(rig["host"]["late"].get<int>() + rig["host"]["out_of_step"].get<int>(), 1);
        EXPECT_GT(rig["host"]["fused"], 0) << rig;
    }
    const nlohmann::json bad = summary["rigs"][2];
    EXPECT_GT(bad["host"]["undecodable"], 0);
    EXPECT_NE(result.err.find("invalid messages of rig hostile"), std::string::npos)
        << "it is named";
    EXPECT_GT(most_mb, 0);
    EXPECT_LT(most_mb, 4000);
}

}  // namespace
}  // namespace vantage
