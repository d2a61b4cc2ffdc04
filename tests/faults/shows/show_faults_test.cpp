// What a show does while programs hang or die, and clocks are set.
#include <csignal>
#include <string>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "tests/faults/shows/two_rig_show.h"
#include "tests/support/eventually.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;

class ShowFaults : public TwoRigShow {};

TEST_F(ShowFaults, HoldTheTicksAndRejoinWhateverBefallsOneRig) {
    start_host({"--seconds", "600"});
    wait_for(*host_, " frames, ");
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
        wait_for(*far_, "publishing on");
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

TEST_F(ShowFaults, AHostThatHangsOrDiesCostsRigsNothing) {
    start_host({"--seconds", "600"});
    wait_for(*host_, " frames, ");
    ASSERT_TRUE(eventually([&] { return far_is("connected"); })) << host_->err();
    host_->send_signal(SIGSTOP);
    // The rigs let a host go that says nothing.
    for (const ChildProgram* rig : {far_.get(), near_.get()}) wait_for(*rig, "is removed");
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
    wait_for(*host_, " frames, ");
    ASSERT_TRUE(eventually([&] { return far_is("connected"); })) << host_->err();
    std::size_t times_right = 0;
    const auto expect_to_be_named_until = [&](const std::string& trouble, int right) {
        wait_for(*host_, trouble);
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
    wait_for(*far_, "publishing on");
    start_host({"--seconds", "600"});
    wait_for(*host_, " frames, ");
    ASSERT_TRUE(eventually([&] { return far_is("connected"); })) << host_->err();
    const auto named_ms = [&](const std::string& words) {
        wait_for(*host_, words);
        const std::string log = host_->err();
        return std::atof(log.c_str() + log.find(words) + words.size());
    };
    far_->send_signal(SIGUSR1);
    EXPECT_NEAR(named_ms("rig far: its clock was set once, last by "), 50, 10);
    far_->send_signal(SIGUSR2);
    EXPECT_NEAR(named_ms("rig far: its clock was set 2 times, last by "), -50, 10);
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
