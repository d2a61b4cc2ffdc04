// What a show does whose rigs come through a relay, when that dies.
#include <csignal>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "tests/faults/shows/two_rig_show.h"

namespace vantage {
namespace {

class RelayFaults : public TwoRigShow {
  protected:
    void TearDown() override {
        host_.reset();
        relay_.reset();
        TwoRigShow::TearDown();
    }

    /// Knows the rigs as a host does. Nobody else listens where it is.
    void start_relay() {
        relay_ = std::make_unique<ChildProgram>(
            VANTAGE_PROGRAM,
            std::vector<std::string>{"relay", "--stage", file("stage.toml"), "--listen",
                                     "tcp://127.0.0.1:5700", "--rigs-file", file("rigs.toml"),
                                     "--json"},
            folder_.path());
        for (const char* rig : {"far", "near"})
            wait_for(*relay_, fmt::format("rig {} is connected", rig));
    }
    /// The stage that has the relay in the rigs' place.
    void write_relayed_stage() const {
        std::ifstream entries(file("rigs.toml"));
        const std::string rigs{std::istreambuf_iterator<char>(entries), {}};
        std::ofstream(file("relayed.toml")) << stage_head << rigs << stage_view;
    }

    std::unique_ptr<ChildProgram> relay_;
};

TEST_F(RelayFaults, ARelayThatDiesCostsTheTicksAndTheRigsNothing) {
    start_relay();
    write_relayed_stage();
    start_host({"--seconds", "600"}, "relayed.toml");
    wait_for(*host_, " pictures, ");
    wait_for_progress();

    relay_->send_signal(SIGKILL);
    EXPECT_EQ(relay_->wait().status, 128 + SIGKILL);
    for (const char* rig : {"far", "near"}) wait_for(*host_, fmt::format("rig {} is gone", rig));
    // The rigs take note of that and film on.
    for (const ChildProgram* rig : {far_.get(), near_.get()}) wait_for(*rig, " is gone");
    wait_for_progress();
    start_relay();
    ASSERT_TRUE(comes([&] {
        return count_of("rig far is connected") == 2 && count_of("rig near is connected") == 2;
    })) << host_->err();
    wait_for_progress();
    wait_for_progress();

    host_->send_signal(SIGINT);
    const ProgramResult result = host_->wait();
    const nlohmann::json summary = nlohmann::json::parse(result.out);
    expect_ticks_held(summary);
    EXPECT_EQ(summary["signal"], "live") << "pictures come again: " << result.err;
    for (const nlohmann::json& rig : summary["rigs"]) {
        EXPECT_EQ(rig["outages"]["count"], 1) << result.err;
        EXPECT_EQ(rig["outages"]["restarts"], 0) << "the rigs went on";
        EXPECT_EQ(rig["state"], "connected");
        expect_balanced(rig);
    }
    for (ChildProgram* rig : {far_.get(), near_.get()}) expect_unharmed(*rig);
    relay_->send_signal(SIGTERM);
    EXPECT_EQ(relay_->wait().status, 0) << relay_->err();
}

}  // namespace
}  // namespace vantage
