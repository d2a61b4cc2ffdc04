// What a show does whose take has no room any more, or a slow disk.
#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>
#include <sched.h>
#include <sys/mount.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>

#include "tests/faults/shows/control_group.h"
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

/// With a disk of its own, an image that a loop device shows. Written data has to reach it at once
/// (`-o sync`): it would stay in memory otherwise until there is none left.
class SlowDiskFaults : public TwoRigShow {
  protected:
    void SetUp() override {
        TwoRigShow::SetUp();
        if (IsSkipped()) return;
        if (const std::string reason = ControlGroup::reason_against("blkio"); !reason.empty())
            GTEST_SKIP() << "SKIPPED: " << reason;
        std::filesystem::create_directory(file("disk"));
        std::ofstream(file("image"));
        std::filesystem::resize_file(file("image"), 300'000'000);
        const ProgramResult made = run_to_end("/sbin/mkfs.ext4", {"-q", file("image")});
        const ProgramResult shown =
            run_to_end("/sbin/losetup", {"--find", "--show", file("image")});
        if (made.status != 0 || shown.status != 0)
            GTEST_SKIP() << "SKIPPED: there is no loop device here: " << made.err << shown.err;
        loop_ = shown.out.substr(0, shown.out.find('\n'));
        struct stat device {};
        ASSERT_EQ(::stat(loop_.c_str(), &device), 0);
        numbers_ = fmt::format("{}:{}", major(device.st_rdev), minor(device.st_rdev));
        if (::unshare(CLONE_NEWNS) != 0 ||
            ::mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) != 0 ||
            ::mount(loop_.c_str(), file("disk").c_str(), "ext4", MS_SYNCHRONOUS, nullptr) != 0)
            GTEST_SKIP() << "SKIPPED: this process may mount no disk";
    }
    void TearDown() override {
        if (!numbers_.empty()) ControlGroup::limit_writes(numbers_, 0);
        TwoRigShow::TearDown();
        if (loop_.empty()) return;
        ::umount2(file("disk").c_str(), MNT_DETACH);
        run_to_end("/sbin/losetup", {"--detach", loop_});
    }

    std::string loop_, numbers_;
};

TEST_F(SlowDiskFaults, DelaysTheTakeAloneAndIsNamed) {
    start_host({"--seconds", "600", "--take", file("disk/take.mkv")});
    host_->wait_for("recording " + file("disk/take.mkv"));
    wait_for_progress();
    // Two rigs send some hundred times as much.
    ControlGroup::limit_writes(numbers_, 1000);
    for (int i = 0; i < 3; ++i) wait_for_progress();
    ControlGroup::limit_writes(numbers_, 0);
    host_->wait_for("the disk is slow; record to a faster one");
    wait_for_progress();
    wait_for_progress();

    host_->send_signal(SIGINT);
    const ProgramResult result = host_->wait();
    const nlohmann::json summary = nlohmann::json::parse(result.out);
    expect_ticks_held(summary);
    expect_no_frame_lost(summary);
    EXPECT_EQ(summary["signal"], "live");
    const nlohmann::json take = summary["take"];
    EXPECT_EQ(take["failure"], "");
    EXPECT_GE(take["longest_unwritten_ms"], 1000);
    for (const nlohmann::json& rig : take["rigs"]) EXPECT_EQ(rig["dropped"], 0) << take;

    const ProgramResult check =
        run_to_end(VANTAGE_PROGRAM, {"take", "check", file("disk/take.mkv"), "--json"});
    EXPECT_EQ(check.status, 0) << check.err << check.out;
    EXPECT_EQ(nlohmann::json::parse(check.out)["whole"], true) << "no gap and no damage";
}

}  // namespace
}  // namespace vantage
