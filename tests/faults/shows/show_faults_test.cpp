// What a show does while networks break and programs hang or die.
#include <csignal>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "common/wire/curve_keys.h"
#include "tests/faults/impaired_road.h"
#include "tests/support/child_program.h"
#include "tests/support/data_folder.h"
#include "tests/support/free_ports.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;

/// Two tiny rigs, "far" at the other end of a road and "near" on this computer, and a host; each a
/// process.
class ShowFaults : public testing::Test {
  protected:
    void SetUp() override {
        if (const std::string reason = ImpairedRoad::reason_against(); !reason.empty())
            GTEST_SKIP() << "SKIPPED: " << reason;
        road_ = std::make_unique<ImpairedRoad>();
        // The loader parts its list at spaces, which a checkout's path may have.
        std::filesystem::create_symlink(VANTAGE_CLOCK_SET, file("clock_set.so"));
        const CurveKeys host_keys = generate_curve_keys(), rig_keys = generate_curve_keys();
        write_key_file(file("host.key"), host_keys);
        write_key_file(file("rig.key"), rig_keys);
        std::ofstream(file("hosts.keys")) << host_keys.public_key << " the host\n";
        near_endpoint_ = fmt::format("tcp://127.0.0.1:{}", two_free_ports().first);
        std::ofstream(file("stage.toml"))
            << "version = 1\nrate_hz = 5\nlatency_budget_ms = 400\nkey_file = \"host.key\"\n"
            << fmt::format(
                   "[[rigs]]\nname = \"far\"\nendpoint = \"tcp://{}:5600\"\n"
                   "public_key = \"{}\"\n",
                   ImpairedRoad::rig_address, rig_keys.public_key)
            << fmt::format("[[rigs]]\nname = \"near\"\nendpoint = \"{}\"\n", near_endpoint_)
            << "[view]\nwidth_px = 96\nheight_px = 64\n";
        far_ = start_far();
        near_ = start_rig("near", 12, fmt::format("bind = \"{}\"\n", near_endpoint_));
        wait_for(*far_, "publishing on");
        wait_for(*near_, "publishing on");
    }
    void TearDown() override {
        host_.reset();
        far_.reset();
        near_.reset();
    }

    std::string file(const std::string& name) const { return (folder_.path() / name).string(); }

    std::unique_ptr<ChildProgram> start_rig(const std::string& name, double azimuth_deg,
                                            const std::string& stream) {
        std::ofstream(file(name + ".toml"))
            << "version = 1\nname = \"" << name
            << "\"\n[source]\nrate_hz = 5\nwidth_px = 96\nheight_px = 72\n"
            << "[virtual_rig]\nazimuth_deg = " << azimuth_deg
            << "\n[match]\nmatcher = \"exact\"\ndisparities = 32\n[stream]\n"
            << stream;
        return std::make_unique<ChildProgram>(
            VANTAGE_RIG_PROGRAM,
            std::vector<std::string>{"run", "--config", file(name + ".toml"), "--json"},
            folder_.path(),
            std::vector<std::string>{"LD_PRELOAD=" + file("clock_set.so"),
                                     fmt::format("CLOCK_SET_MS={}", clock_set_ms_)});
    }
    std::unique_ptr<ChildProgram> start_far() {
        std::unique_ptr<ChildProgram> rig;
        road_->at_the_rigs([&] {
            rig = start_rig("far", -12,
                            "bind = \"tcp://*:5600\"\nkey_file = \"rig.key\"\n"
                            "authorized_hosts = \"hosts.keys\"\n");
        });
        return rig;
    }
    void start_host(const std::vector<std::string>& options) {
        std::vector<std::string> arguments{
            "live",    "--stage", file("stage.toml"), "--headless", "--json", "--wait", "60",
            "--synth", "mesh",    "--rate",           "10"};
        arguments.insert(arguments.end(), options.begin(), options.end());
        host_ = std::make_unique<ChildProgram>(VANTAGE_PROGRAM, arguments, folder_.path());
    }

    template <class Condition>
    static bool comes(Condition condition) {
        for (int i = 0; i < 12000; ++i) {
            if (condition()) return true;
            usleep(10'000);
        }
        return false;
    }
    static void wait_for(const ChildProgram& program, const std::string& words) {
        ASSERT_TRUE(comes([&] { return program.err().find(words) != std::string::npos; }))
            << words << "\n"
            << program.err();
    }
    /// The host's last word of the far rig's connection.
    bool far_is(const std::string& state) const {
        const std::string log = host_->err();
        const auto last = [&](const std::string& word) {
            const std::size_t at = log.rfind("rig far is " + word);
            return at == std::string::npos ? -1 : static_cast<std::ptrdiff_t>(at);
        };
        const std::string other = state == "gone" ? "connected" : "gone";
        return last(state) > last(other);
    }
    /// In the host's log.
    std::size_t count_of(const std::string& words) const {
        const std::string log = host_->err();
        std::size_t count = 0;
        for (std::size_t at = log.find(words); at != std::string::npos;
             at = log.find(words, at + 1))
            ++count;
        return count;
    }
    std::size_t progress() const { return count_of(" pictures, "); }
    void wait_for_progress() {
        const std::size_t now = progress();
        ASSERT_TRUE(comes([&] { return progress() > now; })) << host_->err();
    }

    /// Who waited for a rig, a network or a person would miss ten a second.
    static void expect_ticks_held(const nlohmann::json& summary) {
        EXPECT_GE(summary["pictures"], 20);
        EXPECT_LE(summary["missed_ticks"].get<double>(),
                  1 + 0.02 * summary["pictures"].get<double>())
            << summary["tick_late_ms"];
    }
    static void expect_balanced(const nlohmann::json& rig) {
        const auto count = [&](const char* place, const char* what) {
            return rig[place][what].get<std::int64_t>();
        };
        EXPECT_EQ(count("host", "in_sets"), count("host", "fused") + count("host", "superseded") +
                                                count("host", "in_dropped_sets"))
            << rig;
        const std::int64_t open = count("host", "received") - count("host", "in_sets") -
                                  count("host", "late") - count("host", "duplicate") -
                                  count("host", "unsynchronized") - count("host", "out_of_step");
        EXPECT_GE(open, 0) << rig;
        EXPECT_LE(open, 5 + 1) << "the frames of the latency budget: " << rig;
        EXPECT_GE(count("link", "sent") - count("link", "lost"), count("host", "received")) << rig;
        EXPECT_EQ(count("host", "undecodable"), 0) << rig;
    }

    TemporaryFolder folder_;
    int clock_set_ms_ = 1000;  ///< by which a rig that is started from now on has its clock set
    std::unique_ptr<ImpairedRoad> road_;
    std::string near_endpoint_;
    std::unique_ptr<ChildProgram> far_, near_, host_;
};

TEST_F(ShowFaults, HoldTheTicksAndRejoinWhateverBefallsOneRig) {
    start_host({"--seconds", "600"});
    wait_for(*host_, " pictures, ");
    ASSERT_TRUE(comes([&] { return far_is("connected"); })) << host_->err();

    road_->impair({.lose_every = 10, .delay = 10ms});
    wait_for_progress();
    road_->impair({.is_down = true});
    ASSERT_TRUE(comes([&] { return far_is("gone"); })) << host_->err();
    road_->impair({});
    ASSERT_TRUE(comes([&] { return far_is("connected"); })) << host_->err();

    far_->send_signal(SIGSTOP);
    ASSERT_TRUE(comes([&] { return far_is("gone"); })) << host_->err();
    far_->send_signal(SIGCONT);
    ASSERT_TRUE(comes([&] { return far_is("connected"); })) << host_->err();

    far_->send_signal(SIGKILL);
    ASSERT_TRUE(comes([&] { return far_is("gone"); })) << host_->err();
    // Its port is free once it has ended, which may be later than its connections.
    EXPECT_EQ(far_->wait().status, 128 + SIGKILL);
    far_ = start_far();
    ASSERT_TRUE(comes([&] { return far_is("connected"); })) << host_->err();
    wait_for_progress();

    host_->send_signal(SIGINT);
    const ProgramResult result = host_->wait();
    const nlohmann::json summary = nlohmann::json::parse(result.out);
    expect_ticks_held(summary);
    const nlohmann::json far = summary["rigs"][0], near = summary["rigs"][1];
    EXPECT_GE(far["outages"]["count"], 3) << result.err;
    EXPECT_EQ(far["outages"]["restarts"], 1);
    EXPECT_EQ(far["state"], "connected");
    EXPECT_EQ(near["outages"]["restarts"], 0);
    EXPECT_EQ(near["link"]["lost"], 0) << "the rig beside has noticed nothing";
    expect_balanced(far);
    expect_balanced(near);
    EXPECT_EQ(summary["signal"], "live");
}

TEST_F(ShowFaults, AHostThatHangsOrDiesCostsRigsNothing) {
    start_host({"--seconds", "600"});
    wait_for(*host_, " pictures, ");
    ASSERT_TRUE(comes([&] { return far_is("connected"); })) << host_->err();
    host_->send_signal(SIGSTOP);
    // The rigs let a host go that says nothing.
    for (const ChildProgram* rig : {far_.get(), near_.get()}) wait_for(*rig, "is let go");
    host_->send_signal(SIGCONT);
    wait_for_progress();
    ASSERT_TRUE(comes([&] { return far_is("connected"); })) << host_->err();
    host_->send_signal(SIGKILL);
    EXPECT_EQ(host_->wait().status, 128 + SIGKILL);

    start_host({"--frames", "20"});
    const ProgramResult second = host_->wait();
    EXPECT_EQ(second.status, 0) << second.err;
    const nlohmann::json summary = nlohmann::json::parse(second.out);
    for (const nlohmann::json& rig : summary["rigs"]) {
        EXPECT_EQ(rig["outages"]["restarts"], 0);
        EXPECT_GT(rig["host"]["received"], 0) << second.err;
        expect_balanced(rig);
    }
    for (ChildProgram* rig : {far_.get(), near_.get()}) {
        rig->send_signal(SIGTERM);
        const ProgramResult end = rig->wait();
        EXPECT_EQ(end.status, 0) << end.err;
        const nlohmann::json own = nlohmann::json::parse(end.out);
        EXPECT_EQ(own["captured"].get<std::int64_t>(),
                  own["published"].get<std::int64_t>() + own["late"].get<std::int64_t>())
            << own;
        for (const nlohmann::json& host : own["hosts"]) {
            const auto waiting =
                host["offered"].get<std::int64_t>() - host["sent"].get<std::int64_t>() -
                host["send_dropped"].get<std::int64_t>() - host["thinned"].get<std::int64_t>();
            EXPECT_GE(waiting, 0) << own;
            EXPECT_LE(waiting, 4) << "the queue of a host: " << own;
        }
    }
}

TEST_F(ShowFaults, ARigWhoseClockIsSetIsLeftOutUntilItIsRight) {
    start_host({"--seconds", "600"});
    wait_for(*host_, " pictures, ");
    ASSERT_TRUE(comes([&] { return far_is("connected"); })) << host_->err();
    std::size_t times_right = 0;
    const auto expect_to_be_named_until = [&](const std::string& trouble, int right) {
        wait_for(*host_, trouble);
        far_->send_signal(right);
        ++times_right;
        ASSERT_TRUE(comes([&] { return count_of("rig far is in step again") == times_right; }))
            << host_->err();
    };
    const int ahead = SIGUSR1, back = SIGUSR2;
    far_->send_signal(ahead);
    expect_to_be_named_until("rig far: it counts pulses differently", back);
    far_->send_signal(back);
    expect_to_be_named_until("rig far: its frames come beyond the latency budget", ahead);
    host_->send_signal(SIGINT);
    const ProgramResult result = host_->wait();
    const nlohmann::json summary = nlohmann::json::parse(result.out);
    expect_ticks_held(summary);
    const nlohmann::json far = summary["rigs"][0], near = summary["rigs"][1];
    EXPECT_GT(far["host"]["out_of_step"], 0) << "ahead: " << result.err;
    EXPECT_GT(far["host"]["late"], 0) << "back: " << result.err;
    EXPECT_EQ(far["outages"]["restarts"], 0);
    EXPECT_EQ(near["host"]["out_of_step"], 0);
    EXPECT_EQ(near["link"]["lost"], 0);
    expect_balanced(far);
    expect_balanced(near);
}

TEST_F(ShowFaults, AStepOfARigsClockThatNothingElseShowsIsNamed) {
    far_->send_signal(SIGTERM);
    far_->wait();
    clock_set_ms_ = 50;
    far_ = start_far();
    wait_for(*far_, "publishing on");
    start_host({"--seconds", "600"});
    wait_for(*host_, " pictures, ");
    ASSERT_TRUE(comes([&] { return far_is("connected"); })) << host_->err();
    const auto named_ms = [&](const std::string& words) {
        wait_for(*host_, words);
        const std::string log = host_->err();
        return std::atof(log.c_str() + log.find(words) + words.size());
    };
    far_->send_signal(SIGUSR1);
    EXPECT_NEAR(named_ms("rig far: its clock was set once, by "), 50, 10);
    far_->send_signal(SIGUSR2);
    EXPECT_NEAR(named_ms("rig far: its clock was set 2 times, by "), -50, 10);
    host_->send_signal(SIGINT);
    const ProgramResult result = host_->wait();
    const nlohmann::json summary = nlohmann::json::parse(result.out);
    const nlohmann::json far = summary["rigs"][0];
    EXPECT_EQ(far["host"]["out_of_step"], 0) << "nothing else tells";
    EXPECT_THAT(far["clock"].get<std::string>(), testing::HasSubstr("set 2 times"));
    expect_balanced(far);
}

}  // namespace
}  // namespace vantage
