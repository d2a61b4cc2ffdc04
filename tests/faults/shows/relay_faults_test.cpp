// What a show does one of whose rigs comes through a relay, when that dies.
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "tests/faults/shows/two_rig_show.h"
#include "tests/support/eventually.h"

namespace vantage {
namespace {

class RelayFaults : public TwoRigShow {
  protected:
    void TearDown() override {
        host_.reset();
        relay_.reset();
        TwoRigShow::TearDown();
    }

    /// Knows the far rig as a host does. Nobody else listens where it is.
    void start_relay() {
        std::ofstream(file("far.toml")) << stage_head << far_entry_ << stage_view;
        relay_ = std::make_unique<ChildProgram>(
            VANTAGE_PROGRAM,
            std::vector<std::string>{"relay", "--stage", file("far.toml"), "--listen",
                                     "tcp://127.0.0.1:5700", "--rigs-file", file("rigs.toml"),
                                     "--json"},
            folder_.path());
        relay_->wait_for("rig far is connected");
        ASSERT_TRUE(eventually([&] { return std::filesystem::exists(file("rigs.toml")); }));
    }
    /// The stage that has the relay in the far rig's place.
    void write_relayed_stage() const {
        std::ifstream entries(file("rigs.toml"));
        const std::string far{std::istreambuf_iterator<char>(entries), {}};
        std::ofstream(file("relayed.toml")) << stage_head << far << near_entry_ << stage_view;
    }

    std::unique_ptr<ChildProgram> relay_;
};

TEST_F(RelayFaults, ARelayThatDiesCostsTheTicksAndTheOtherRigNothing) {
    start_relay();
    write_relayed_stage();
    start_host({"--seconds", "600"}, "relayed.toml");
    host_->wait_for(" frames, ");
    // With pictures of one rig it begins.
    ASSERT_TRUE(eventually([&] { return far_is("connected"); })) << host_->err() << relay_->err();
    wait_for_progress();

    relay_->send_signal(SIGKILL);
    EXPECT_EQ(relay_->wait().status, 128 + SIGKILL);
    host_->wait_for("rig far is gone");
    // The rig takes note of that and films on.
    far_->wait_for(" disconnected");
    wait_for_progress();
    EXPECT_LE(sets_until_far_is_back([&] { start_relay(); }), sets_to_recover) << host_->err();
    wait_for_progress();
    wait_for_progress();

    host_->send_signal(SIGINT);
    const ProgramResult result = host_->wait();
    const nlohmann::json summary = nlohmann::json::parse(result.out);
    expect_ticks_held(summary);
    EXPECT_EQ(summary["signal"], "live") << "pictures come again: " << result.err;
    const nlohmann::json far = summary["rigs"][0], near = summary["rigs"][1];
    EXPECT_EQ(far["outages"]["count"], 1) << result.err;
    EXPECT_EQ(far["outages"]["restarts"], 0) << "the rig went on";
    EXPECT_EQ(far["state"], "connected");
    EXPECT_EQ(near["outages"]["count"], 0);
    EXPECT_EQ(near["link"]["lost"], 0) << "the rig beside has noticed nothing";
    expect_balanced(far);
    expect_balanced(near);
    for (ChildProgram* rig : {far_.get(), near_.get()}) expect_unharmed(*rig);
    relay_->send_signal(SIGTERM);
    EXPECT_EQ(relay_->wait().status, 0) << relay_->err();
}

}  // namespace
}  // namespace vantage
