// What a show does whose take has no room any more.
#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>
#include <sched.h>
#include <sys/mount.h>

#include "tests/faults/shows/two_rig_show.h"

namespace vantage {
namespace {

using testing::HasSubstr;

/// With a small disk, a tmpfs that is this process's and its children's.
class DiskFaults : public TwoRigShow {
  protected:
    void SetUp() override {
        TwoRigShow::SetUp();
        if (IsSkipped()) return;
        std::filesystem::create_directory(file("disk"));
        // Before a take the host writes up to 64 MB to see how fast its disk is.
        if (::unshare(CLONE_NEWNS) != 0 ||
            ::mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) != 0 ||
            ::mount("tmpfs", file("disk").c_str(), "tmpfs", 0, "size=72m") != 0)
            GTEST_SKIP() << "SKIPPED: this process may mount no tmpfs";
    }
    void TearDown() override {
        TwoRigShow::TearDown();
        ::umount2(file("disk").c_str(), MNT_DETACH);
    }

    /// As another program would.
    void fill_disk() const {
        std::ofstream filler(file("disk/filler"));
        const std::string piece(1 << 16, 'x');
        while (filler.write(piece.data(), static_cast<std::streamsize>(piece.size())).flush()) {
        }
    }
};

TEST_F(DiskFaults, ATakeWhoseDiskIsFullEndsAndTheProgrammeGoesOn) {
    start_host({"--seconds", "600", "--take", file("disk/take.mkv")});
    host_->wait_for("recording " + file("disk/take.mkv"));
    wait_for_progress();
    wait_for_progress();
    fill_disk();
    host_->wait_for("No space left on device");
    wait_for_progress();
    wait_for_progress();

    host_->send_signal(SIGINT);
    const ProgramResult result = host_->wait();
    EXPECT_THAT(result.err, HasSubstr("an output failed"));
    const nlohmann::json summary = nlohmann::json::parse(result.out);
    expect_ticks_held(summary);
    EXPECT_EQ(summary["signal"], "live");
    for (const nlohmann::json& rig : summary["rigs"]) {
        EXPECT_EQ(rig["outages"]["count"], 0);
        EXPECT_EQ(rig["link"]["lost"], 0);
        EXPECT_EQ(rig["host"]["queue_dropped"], 0);
        expect_balanced(rig);
    }
    const nlohmann::json take = summary["take"];
    EXPECT_EQ(take["state"], "failed");
    EXPECT_THAT(take["failure"].get<std::string>(),
                HasSubstr("No space left on device; what was written until then can be opened"));

    const ProgramResult check =
        run_to_end(VANTAGE_PROGRAM, {"take", "check", file("disk/take.mkv"), "--json"});
    EXPECT_EQ(check.status, 0) << check.err << check.out;
    const nlohmann::json verdict = nlohmann::json::parse(check.out);
    EXPECT_EQ(verdict["whole"], true) << "no gap and no damage";
    EXPECT_GE(verdict["frames"], 10) << verdict;
}

}  // namespace
}  // namespace vantage
