#include <csignal>
#include <fstream>
#include <memory>
#include <string>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "common/wire/curve_keys.h"
#include "tests/support/child_program.h"
#include "tests/support/data_folder.h"
#include "tests/support/eventually.h"
#include "tests/support/free_ports.h"

namespace vantage {
namespace {

using testing::HasSubstr;
using testing::Not;

/// Rigs with faults and the reports of the host; every program is a process.
class RigTroubles : public testing::Test {
  protected:
    std::string file(const std::string& name) const { return (folder_.path() / name).string(); }
    std::string endpoint(int port) const { return fmt::format("tcp://127.0.0.1:{}", port); }

    /// Two rigs: "north" and "south".
    void write_stage(const std::string& north, const std::string& south,
                     const std::string& keys_of_north = "", const std::string& top = "") {
        std::ofstream(file("stage.toml"))
            << "version = 1\nrate_hz = 5\nlatency_budget_ms = 1000\n"
            << top << "[[rigs]]\nname = \"north\"\nendpoint = \"" << north << "\"\n"
            << keys_of_north << "[[rigs]]\nname = \"south\"\nendpoint = \"" << south << "\"\n"
            << "[view]\nwidth_px = 128\nheight_px = 72\n";
    }

    std::unique_ptr<ChildProgram> start_rig(const std::string& name, int port, double rate_hz,
                                            const std::string& stream = "",
                                            const std::string& matcher = "exact") {
        std::ofstream(file(name + ".toml"))
            << "version = 1\nname = \"" << name << "\"\n[source]\nrate_hz = " << rate_hz
            << "\nwidth_px = 160\nheight_px = 120\n[match]\nmatcher = \"" << matcher
            << "\"\ndisparities = 32\n"
            << "[stream]\nbind = \"" << endpoint(port) << "\"\n"
            << stream;
        return std::make_unique<ChildProgram>(
            VANTAGE_RIG_PROGRAM, std::vector<std::string>{"run", "--config", file(name + ".toml")},
            folder_.path());
    }

    ProgramResult status(double wait_s, bool as_json = false) const {
        std::vector<std::string> arguments{
            "rigs", "status", "--stage", file("stage.toml"), "--wait", fmt::format("{}", wait_s)};
        if (as_json) arguments.emplace_back("--json");
        return run_to_end(VANTAGE_PROGRAM, arguments);
    }

    TemporaryFolder folder_;
    const std::pair<int, int> ports_ = two_free_ports();
};

TEST_F(RigTroubles, AreReportedWithTheReasonOfEachRig) {
    write_stage("tcp://no-such-rig.invalid:5600", endpoint(ports_.second),
                "public_key = \"" + generate_curve_keys().public_key + "\"\n",
                "key_file = \"host.key\"\n");
    write_key_file(file("host.key"), generate_curve_keys());
    const ProgramResult result = status(5);
    EXPECT_EQ(result.status, 1);
    EXPECT_EQ(result.err, "vantage: error: 2 of 2 rigs cannot send frames: north, south\n");
    EXPECT_THAT(result.out,
                HasSubstr("north: disconnected: the name no-such-rig.invalid does not resolve"));
    EXPECT_THAT(result.out,
                HasSubstr("south: disconnected: connection refused at " + endpoint(ports_.second)));
    EXPECT_THAT(result.out, HasSubstr("synchronisation: not measured"));
    EXPECT_THAT(result.out, HasSubstr("signal: NO SIGNAL"));
}

TEST_F(RigTroubles, SayThatAStoppedRigMayBeTheReason) {
    const auto north = start_rig("north", ports_.first, 5);
    north->wait_for("publishing on");
    north->send_signal(SIGSTOP);
    write_stage(endpoint(ports_.first), endpoint(ports_.second));
    const ProgramResult result = status(5);
    north->send_signal(SIGCONT);
    EXPECT_EQ(result.status, 1);
    EXPECT_THAT(result.out,
                HasSubstr("north: disconnected: something at " + endpoint(ports_.first) +
                          " accepts connections but does not speak Vantage's protocol: the rig or "
                          "this host is stopped or busy"));
}

TEST_F(RigTroubles, WithKeysNameTheWrongKey) {
    const CurveKeys rig_keys = generate_curve_keys();
    write_key_file(file("rig.key"), rig_keys);
    write_key_file(file("host.key"), generate_curve_keys());
    std::ofstream(file("authorized_hosts")) << "# none\n";
    const auto north =
        start_rig("north", ports_.first, 5,
                  "key_file = \"rig.key\"\nauthorized_hosts = \"authorized_hosts\"\n");
    north->wait_for("publishing on");
    const std::string top = "key_file = \"host.key\"\n";
    // South is the same rig without a key.
    write_stage(endpoint(ports_.first), endpoint(ports_.first),
                "public_key = \"" + rig_keys.public_key + "\"\n", top);
    ProgramResult result = status(60, true);
    EXPECT_EQ(result.status, 1);
    EXPECT_THAT(result.err, HasSubstr("north: rig north at " + endpoint(ports_.first) +
                                      " does not admit this host"));
    EXPECT_THAT(result.err, HasSubstr("south: rig south at " + endpoint(ports_.first) +
                                      " accepts only hosts with keys"));
    EXPECT_EQ(nlohmann::json::parse(result.out)["signal"], "no_signal");

    write_stage(endpoint(ports_.first), endpoint(ports_.first),
                "public_key = \"" + generate_curve_keys().public_key + "\"\n", top);
    result = status(60, true);
    EXPECT_EQ(result.status, 1);
    EXPECT_THAT(result.err, HasSubstr("does not have the key"));
}

TEST_F(RigTroubles, DoNotIncludeArmedRigs) {
    write_stage(endpoint(ports_.first), endpoint(ports_.second));
    const std::string armed = "[trigger]\nrole = \"lead\"\npretended = true\n";
    const auto north = start_rig("north", ports_.first, 5, armed);
    const auto south = start_rig("south", ports_.second, 5, armed);
    north->wait_for("publishing on");
    south->wait_for("publishing on");
    const ProgramResult result = status(60, true);
    EXPECT_EQ(result.status, 0) << result.err;
    const nlohmann::json told = nlohmann::json::parse(result.out);
    EXPECT_EQ(told["signal"], "no_signal");
    ASSERT_TRUE(told["rigs"][1].contains("silence")) << told;
    EXPECT_THAT(told["rigs"][1]["silence"].get<std::string>(), HasSubstr("vantage live"));
}

TEST_F(RigTroubles, IncludeARigAtAnotherRate) {
    write_stage(endpoint(ports_.first), endpoint(ports_.second));
    const auto north = start_rig("north", ports_.first, 2);
    const auto south = start_rig("south", ports_.second, 5);
    north->wait_for("publishing on");
    south->wait_for("publishing on");
    const ProgramResult result = status(60, true);
    EXPECT_EQ(result.status, 1);
    EXPECT_THAT(result.err, HasSubstr("north: it runs at 2 Hz and the stage at 5 Hz"));
    EXPECT_THAT(result.err, Not(HasSubstr("south:")));
    const nlohmann::json rigs = nlohmann::json::parse(result.out)["rigs"];
    EXPECT_EQ(rigs[0]["sync"]["rate_hz"], 2);
    EXPECT_EQ(rigs[1]["sync"]["rate_hz"], 5);
}

TEST_F(RigTroubles, OfACommonRateLeaveASignal) {
    write_stage(endpoint(ports_.first), endpoint(ports_.second));
    const auto north = start_rig("north", ports_.first, 4);
    const auto south = start_rig("south", ports_.second, 4);
    north->wait_for("publishing on");
    south->wait_for("publishing on");
    ChildProgram host(VANTAGE_PROGRAM,
                      {"live", "--stage", file("stage.toml"), "--headless", "--json", "--seconds",
                       "600", "--wait", "60"},
                      folder_.path());
    host.wait_for(" 2 of 2 rigs");
    const ProgramResult looked = status(60, true);
    EXPECT_EQ(looked.status, 1);
    EXPECT_THAT(looked.err, HasSubstr("north: it runs at 4 Hz and the stage at 5 Hz"));
    const nlohmann::json told = nlohmann::json::parse(looked.out);
    EXPECT_EQ(told["signal"], "live");
    const std::string reason = "it runs at 4 Hz";
    const ProgramResult read = status(60);
    EXPECT_THAT(read.out, HasSubstr("north: connected: " + reason));
    EXPECT_THAT(read.err, HasSubstr("error: 2 of 2 rigs cannot send frames: north, south\n"));
    EXPECT_THAT(read.err, Not(HasSubstr(reason))) << "once is enough";
    for (const nlohmann::json& rig : told["rigs"]) EXPECT_TRUE(rig["delivers"]) << rig;
    host.send_signal(SIGINT);
    const ProgramResult result = host.wait();
    EXPECT_EQ(nlohmann::json::parse(result.out)["signal"], "live") << result.err;
    EXPECT_THAT(result.err, HasSubstr(" 2 of 2 rigs"));
}

TEST_F(RigTroubles, AreCountedWhenARigRestarts) {
    write_stage(endpoint(ports_.first), endpoint(ports_.second));
    auto north = start_rig("north", ports_.first, 5);
    const auto south = start_rig("south", ports_.second, 5);
    ChildProgram host(VANTAGE_PROGRAM,
                      {"live", "--stage", file("stage.toml"), "--headless", "--json", "--seconds",
                       "600", "--wait", "60"},
                      folder_.path());
    host.wait_for(" frames, ");
    north->send_signal(SIGKILL);
    host.wait_for("rig north is gone");
    // Its port is free when it has ended, which may be later than its connections.
    EXPECT_EQ(north->wait().status, 128 + SIGKILL);
    north = start_rig("north", ports_.first, 5);
    // The log's last line about it says that it is gone.
    const auto back = [&] {
        const std::string log = host.err();
        return log.rfind("rig north is connected") > log.rfind("rig north is gone");
    };
    ASSERT_TRUE(eventually(back)) << host.err() << "\nthe rig: " << north->err();
    sleep(2);
    host.send_signal(SIGINT);
    const ProgramResult result = host.wait();
    const nlohmann::json summary = nlohmann::json::parse(result.out);
    const nlohmann::json rig = summary["rigs"][0];
    EXPECT_EQ(rig["outages"]["count"], 1) << result.err;
    EXPECT_EQ(rig["outages"]["restarts"], 1);
    EXPECT_GT(rig["outages"]["total_s"], 0);
    EXPECT_GE(rig["link"]["sent"].get<int>() - rig["link"]["lost"].get<int>(),
              rig["host"]["received"].get<int>());
    EXPECT_GT(rig["host"]["received"], 0);
    EXPECT_EQ(summary["signal"], "live");
}

TEST_F(RigTroubles, OfASlowNetworkAreReportedByThePlan) {
    write_stage(endpoint(ports_.first), endpoint(ports_.second));
    const auto north = start_rig("north", ports_.first, 5);
    const auto south = start_rig("south", ports_.second, 5, "", "coarse");
    const std::vector<std::string> arguments{"rigs",      "plan",  "--stage", file("stage.toml"),
                                             "--seconds", "1",     "--wait",  "60",
                                             "--start",   "--json"};
    const ProgramResult wide = run_to_end(VANTAGE_PROGRAM, arguments);
    ASSERT_EQ(wide.status, 0) << wide.err;
    const nlohmann::json plan = nlohmann::json::parse(wide.out);
    EXPECT_TRUE(plan["fits"]);
    for (const nlohmann::json& rig : plan["rigs"]) {
        EXPECT_GE(rig["frames"], 2) << plan;
        EXPECT_NEAR(rig["mbit_s"].get<double>(),
                    8e-6 * 1.073 * 5 *
                        (rig["colour_bytes"].get<double>() + rig["other_bytes"].get<double>()),
                    0.01);
    }
    EXPECT_GT(plan["rigs"][1].value("gpu_ms", 0.0), 0.1) << plan;
    ASSERT_FALSE(plan["gpu_fits"].empty()) << plan;
    for (const nlohmann::json& fit : plan["gpu_fits"]) {
        EXPECT_EQ(fit["rate_hz"], 5);
        EXPECT_GT(fit["lower_bounds_ms"]["quality"], fit["lower_bounds_ms"]["fast"]);
    }
    std::vector<std::string> narrow = arguments;
    narrow.insert(narrow.end(), {"--rate", "1000", "--host-link", "100"});
    const ProgramResult refused = run_to_end(VANTAGE_PROGRAM, narrow);
    EXPECT_EQ(refused.status, 1);
    EXPECT_THAT(refused.err, HasSubstr("Mbit/s of a link of 100, of which 80 %"));
    const nlohmann::json proposals = nlohmann::json::parse(refused.out)["proposals"];
    ASSERT_FALSE(proposals.empty());
    EXPECT_LE(proposals[0]["host_mbit_s"], 80);
}

TEST_F(RigTroubles, OfASlowStartDoNotKeepARigFromThePlan) {
    write_stage(endpoint(ports_.first), endpoint(ports_.second));
    const auto north = start_rig("north", ports_.first, 5);
    const auto south = start_rig("south", ports_.second, 5);
    ChildProgram plan(VANTAGE_PROGRAM,
                      {"rigs", "plan", "--stage", file("stage.toml"), "--seconds", "1", "--wait",
                       "60", "--start", "--json"},
                      folder_.path());
    plan.wait_for("the stage's first pulse is");
    south->send_signal(SIGSTOP);
    sleep(3);  // longer than the measurement
    south->send_signal(SIGCONT);
    const ProgramResult result = plan.wait();
    ASSERT_EQ(result.status, 0) << result.err;
    for (const nlohmann::json& rig : nlohmann::json::parse(result.out)["rigs"])
        EXPECT_GE(rig["frames"], 1) << rig;
}

}  // namespace
}  // namespace vantage
