// A show holds its ticks and frames while a rig's PTP grandmaster changes.
#include <csignal>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "tests/faults/shows/two_rig_show.h"
#include "tests/support/eventually.h"
#include "tests/support/source_folder.h"

namespace vantage {
namespace {

class PtpMasters : public TwoRigShow {
  protected:
    static std::string reason_against() {
        if (!std::filesystem::exists("/usr/sbin/ptp4l"))
            return "there is no ptp4l (package linuxptp)";
        const ProgramResult made = run_to_end(
            "/usr/bin/unshare", {"--net", "ip", "link", "add", "bridge", "type", "bridge"});
        return made.status == 0 ? "" : "this kernel has no bridges: " + made.err;
    }

    /// How often the rig's ptp4l has chosen a grandmaster.
    std::size_t choices() const {
        std::ifstream log(file("rig.ptp"));
        std::size_t count = 0;
        for (std::string line; std::getline(log, line);)
            count += line.find("selected best master clock") != line.npos;
        return count;
    }
    void touch(const std::string& name) const { std::ofstream(file(name)) << '\n'; }
};

TEST_F(PtpMasters, ChangeWithoutALostFrameOrTick) {
    if (const std::string reason = reason_against(); !reason.empty())
        GTEST_SKIP() << "SKIPPED: " << reason;
    far_->send_signal(SIGTERM);
    far_->wait();
    road_->at_the_rigs([&] {
        far_ = std::make_unique<ChildProgram>(
            "/usr/bin/unshare",
            std::vector<std::string>{
                "--mount", "--pid", "--fork", "--kill-child",
                (source_folder() / "tests/faults/shows/ptp_masters.sh").string(),
                folder_.path().string(), VANTAGE_RIG_PROGRAM, "run", "--config", file("far.toml")},
            folder_.path());
    });
    far_->wait_for("publishing on");
    start_host({"--seconds", "600"});
    host_->wait_for(" frames, ");
    ASSERT_TRUE(eventually([&] { return far_is("connected"); })) << host_->err();
    ASSERT_TRUE(eventually([&] { return choices() >= 1; })) << far_->err();

    const auto change_by = [&](const std::string& name) {
        const std::size_t before = choices();
        touch(name);
        EXPECT_TRUE(eventually([&] { return choices() > before; })) << name;
    };
    EXPECT_EQ(sets_until_far_is_back([&] { change_by("second"); }), 0) << host_->err();
    EXPECT_EQ(sets_until_far_is_back([&] { change_by("second_gone"); }), 0) << host_->err();

    host_->send_signal(SIGINT);
    const ProgramResult result = host_->wait();
    const nlohmann::json summary = nlohmann::json::parse(result.out);
    expect_ticks_held(summary);
    expect_no_frame_lost(summary);
    // ptp4l sets no clock here, which the host names.
    EXPECT_THAT(summary["rigs"][0]["clock"].get<std::string>(),
                testing::HasSubstr("clocks not disciplined: skew unknown (ptp4l is "));
}

}  // namespace
}  // namespace vantage
