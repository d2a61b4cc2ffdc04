// What a show does while programs hang or die, and clocks are set.
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/faults/shows/control_group.h"
#include "tests/faults/shows/two_rig_show.h"
#include "tests/support/eventually.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;

class ShowFaults : public TwoRigShow {
  protected:
    /// Ends the host. `restarts` is how often the far rig was started again.
    void end_and_expect_trouble_of_far_alone(int restarts) {
        host_->send_signal(SIGINT);
        const ProgramResult result = host_->wait();
        const nlohmann::json summary = nlohmann::json::parse(result.out);
        expect_ticks_held(summary);
        const nlohmann::json far = summary["rigs"][0], near = summary["rigs"][1];
        EXPECT_EQ(far["outages"]["restarts"], restarts);
        EXPECT_EQ(near["outages"]["count"], 0);
        EXPECT_EQ(near["link"]["lost"], 0) << "the rig beside has noticed nothing";
        expect_balanced(far);
        expect_balanced(near);
    }
};

TEST_F(ShowFaults, HoldTheTicksAndRejoinWhateverBefallsOneRig) {
    start_host({"--seconds", "600"});
    host_->wait_for(" frames, ");
    ASSERT_TRUE(eventually([&] { return far_is("connected"); })) << host_->err();

    road_->impair({.lose_every = 10, .delay = 10ms});
    wait_for_progress();
    road_->impair({.is_down = true});
    ASSERT_TRUE(eventually([&] { return far_is("gone"); })) << host_->err();
    road_->impair({});
    ASSERT_TRUE(eventually([&] { return far_is("connected"); })) << host_->err();

    far_->send_signal(SIGSTOP);
    ASSERT_TRUE(eventually([&] { return far_is("gone"); })) << host_->err();
    EXPECT_LE(sets_until_far_is_back([&] { far_->send_signal(SIGCONT); }), sets_to_recover)
        << host_->err();
    EXPECT_TRUE(far_is("connected")) << host_->err();

    far_->send_signal(SIGKILL);
    ASSERT_TRUE(eventually([&] { return far_is("gone"); })) << host_->err();
    // Its port is free once it has ended, which may be later than its connections.
    EXPECT_EQ(far_->wait().status, 128 + SIGKILL);
    const auto start_again = [&] {
        far_ = start_far();
        far_->wait_for("publishing on");
    };
    EXPECT_LE(sets_until_far_is_back(start_again), sets_to_recover) << host_->err();
    EXPECT_TRUE(far_is("connected")) << host_->err();
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

TEST_F(ShowFaults, ARigThatIsThrottledLosesOnlyItsOwnFramesAndIsNamed) {
    if (const std::string reason = ControlGroup::reason_against("cpu"); !reason.empty())
        GTEST_SKIP() << "SKIPPED: " << reason;
    far_->send_signal(SIGTERM);
    far_->wait();
    const ControlGroup group("cpu");
    group.run_inside([&] { far_ = start_far(); });
    far_->wait_for("publishing on");
    start_host({"--seconds", "600"});
    host_->wait_for(" frames, ");
    ASSERT_TRUE(eventually([&] { return far_is("connected"); })) << host_->err();

    // As a processor does that is too hot, but by more.
    group.limit_processor(0.01);
    ASSERT_TRUE(eventually([&] {
        return far_is("gone") ||
               count_of("rig far: its frames arrive after the latency budget") > 0;
    })) << host_->err();
    wait_for_progress();
    wait_for_progress();
    EXPECT_LE(sets_until_far_is_back([&] { group.limit_processor(0); }), sets_to_recover)
        << host_->err();

    end_and_expect_trouble_of_far_alone(0);
    far_->send_signal(SIGTERM);
    far_->wait();
}

/// How readily the kernel kills this process and those that it starts when memory is short.
void set_oom_score(int score) {
    if (!(std::ofstream("/proc/self/oom_score_adj") << score << std::flush))
        ADD_FAILURE() << "cannot set oom_score_adj";
}

/// A process that takes memory until there is none, and holds it.
pid_t start_hog() {
    const pid_t hog = ::fork();
    if (hog != 0) return hog;
    constexpr std::size_t piece_bytes = 1 << 20;
    while (true) {
        void* piece = ::mmap(nullptr, piece_bytes, PROT_READ | PROT_WRITE,
                             MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
        if (piece == MAP_FAILED) ::pause();
        std::memset(piece, 1, piece_bytes);
    }
}

TEST_F(ShowFaults, ARigThatTheKernelKillsForMemoryIsGoneAloneAndComesBack) {
    if (const std::string reason = ControlGroup::reason_against("memory"); !reason.empty())
        GTEST_SKIP() << "SKIPPED: " << reason;
    far_->send_signal(SIGTERM);
    far_->wait();
    const ControlGroup group("memory");
    constexpr std::int64_t limit_bytes = 700'000'000;
    group.set("memory.limit_in_bytes", limit_bytes);
    set_oom_score(1000);
    group.run_inside([&] { far_ = start_far(); });
    far_->wait_for("publishing on");
    set_oom_score(0);
    start_host({"--seconds", "600"});
    host_->wait_for(" frames, ");
    ASSERT_TRUE(eventually([&] { return far_is("connected"); })) << host_->err();

    pid_t hog = -1;
    group.run_inside([&] { hog = start_hog(); });
    EXPECT_EQ(far_->wait().status, 128 + SIGKILL);
    ASSERT_TRUE(eventually([&] { return far_is("gone"); })) << host_->err();
    ::kill(hog, SIGKILL);
    ::waitpid(hog, nullptr, 0);
    wait_for_progress();
    far_ = start_far();
    far_->wait_for("publishing on");
    EXPECT_LE(sets_until_far_is_back([] {}), sets_to_recover) << host_->err();

    end_and_expect_trouble_of_far_alone(1);
}

/// A process that reads a large file again and again, so that its group's memory is always full of
/// it and the kernel has to make room for every page that anyone else wants.
pid_t start_reader(const std::string& path) {
    const pid_t reader = ::fork();
    if (reader != 0) return reader;
    std::string piece(1 << 20, ' ');
    while (true) {
        std::ifstream file(path);
        while (file.read(piece.data(), static_cast<std::streamsize>(piece.size()))) {
        }
    }
}

TEST_F(ShowFaults, AHostThatIsShortOfMemoryHoldsItsTicks) {
    if (const std::string reason = ControlGroup::reason_against("memory"); !reason.empty())
        GTEST_SKIP() << "SKIPPED: " << reason;
    const ControlGroup group("memory");
    group.run_inside([&] { start_host({"--seconds", "600", "--take", file("take.mkv")}); });
    host_->wait_for("recording ");
    wait_for_progress();
    wait_for_progress();
    // Room for what the host may still take, which the reader fills.
    constexpr std::int64_t room_bytes = 100'000'000;
    std::ofstream(file("large"));
    std::filesystem::resize_file(file("large"), 10 * room_bytes);
    group.set("memory.limit_in_bytes", group.value_of("memory.usage_in_bytes") + room_bytes);
    pid_t reader = -1;
    group.run_inside([&] { reader = start_reader(file("large")); });
    for (int i = 0; i < 3; ++i) wait_for_progress();
    EXPECT_GT(group.value_of("memory.failcnt"), 1000) << "how often the group was full";
    ::kill(reader, SIGKILL);
    ::waitpid(reader, nullptr, 0);

    host_->send_signal(SIGINT);
    const ProgramResult result = host_->wait();
    EXPECT_EQ(result.status, 128 + SIGINT) << result.err;
    const nlohmann::json summary = nlohmann::json::parse(result.out);
    expect_ticks_held(summary);
    expect_no_frame_lost(summary);
    EXPECT_EQ(summary["take"]["failure"], "");
}

TEST_F(ShowFaults, AHostThatHangsOrDiesCostsRigsNothing) {
    start_host({"--seconds", "600"});
    host_->wait_for(" frames, ");
    ASSERT_TRUE(eventually([&] { return far_is("connected"); })) << host_->err();
    host_->send_signal(SIGSTOP);
    // The rigs let a host go that says nothing.
    for (ChildProgram* rig : {far_.get(), near_.get()}) rig->wait_for("is removed");
    EXPECT_LE(frames_beside_until_both_are_back([&] { host_->send_signal(SIGCONT); }),
              sets_to_recover)
        << host_->err();
    wait_for_progress();
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
    for (ChildProgram* rig : {far_.get(), near_.get()}) expect_unharmed(*rig);
}

TEST_F(ShowFaults, ARigWhoseClockIsSetIsLeftOutUntilItIsRight) {
    start_host({"--seconds", "600"});
    host_->wait_for(" frames, ");
    ASSERT_TRUE(eventually([&] { return far_is("connected"); })) << host_->err();
    std::size_t times_right = 0;
    const auto expect_to_be_named_until = [&](const std::string& trouble, int right) {
        host_->wait_for(trouble);
        far_->send_signal(right);
        ++times_right;
        ASSERT_TRUE(eventually([&] { return count_of("rig far is in step again") == times_right; }))
            << host_->err();
    };
    const int ahead = SIGUSR1, back = SIGUSR2;
    far_->send_signal(ahead);
    expect_to_be_named_until("rig far: it counts pulses differently", back);
    far_->send_signal(back);
    expect_to_be_named_until("rig far: its frames arrive after the latency budget", ahead);
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
    far_->wait_for("publishing on");
    start_host({"--seconds", "600"});
    host_->wait_for(" frames, ");
    ASSERT_TRUE(eventually([&] { return far_is("connected"); })) << host_->err();
    far_->send_signal(SIGUSR1);
    EXPECT_NEAR(named_by_host("rig far: its clock was set once, last by "), 50, 10);
    far_->send_signal(SIGUSR2);
    EXPECT_NEAR(named_by_host("rig far: its clock was set 2 times, last by "), -50, 10);
    host_->send_signal(SIGINT);
    const ProgramResult result = host_->wait();
    const nlohmann::json summary = nlohmann::json::parse(result.out);
    const nlohmann::json far = summary["rigs"][0];
    EXPECT_EQ(far["host"]["out_of_step"], 0) << "nothing else tells";
    EXPECT_THAT(far["clock"].get<std::string>(), testing::HasSubstr("set 2 times"));
    expect_balanced(far);
}

TEST_F(ShowFaults, AStepOfTheHostsClockIsNamedAndCostsNeitherTicksNorFrames) {
    start_host({"--seconds", "600", "--take", file("take.mkv")}, "stage.toml",
               {"LD_PRELOAD=" + file("clock_set.so"), "CLOCK_SET_MS=60000"});
    host_->wait_for(" frames, ");
    ASSERT_TRUE(eventually([&] { return far_is("connected"); })) << host_->err();
    const int ahead = SIGUSR1, back = SIGUSR2;
    EXPECT_EQ(sets_until_far_is_back([&] { host_->send_signal(ahead); }), 0) << host_->err();
    EXPECT_NEAR(named_by_host("the clock of this computer was set by +"), 60'000, 10'000);
    EXPECT_EQ(sets_until_far_is_back([&] { host_->send_signal(back); }), 0) << host_->err();
    EXPECT_NEAR(named_by_host("the clock of this computer was set by -"), 60'000, 10'000);
    host_->send_signal(SIGINT);
    const ProgramResult result = host_->wait();
    EXPECT_EQ(result.status, 130) << result.err;
    const nlohmann::json summary = nlohmann::json::parse(result.out);
    expect_ticks_held(summary);
    expect_no_frame_lost(summary);
    for (const nlohmann::json& rig : summary["take"]["rigs"]) {
        EXPECT_EQ(rig["refused"], 0) << "the take goes on";
        EXPECT_GT(rig["frames"], 20);
    }
}

}  // namespace
}  // namespace vantage
