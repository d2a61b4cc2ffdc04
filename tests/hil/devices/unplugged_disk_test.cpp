// A disk that is pulled while a take or a film is on it: the kernel's scsi_debug, a disk in memory.
#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <sys/mount.h>

#include "common/base/child_process.h"
#include "common/take/take_recorder.h"
#include "host_app/output/output_target.h"
#include "tests/support/data_folder.h"
#include "tests/support/eventually.h"
#include "tests/support/thrown_sentence.h"
#include "tests/unit/common/take/small_take.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;

/// A new disk of the driver with a file system; mounted until destroyed.
class Disk {
  public:
    Disk() {
        write("/sys/bus/pseudo/drivers/scsi_debug/add_host", "1");
        if (!eventually([&] { return is_found(); })) return;
        const std::string device = "/dev/" + name_;
        ChildProcess({.program = "/bin/busybox", .arguments = {"mke2fs", device}}).wait();
        is_there_ = ::mount(device.c_str(), folder().c_str(), "ext4", 0, "") == 0;
    }
    ~Disk() { ::umount2(folder().c_str(), MNT_DETACH); }
    Disk(const Disk&) = delete;
    Disk& operator=(const Disk&) = delete;

    bool is_there() const { return is_there_; }
    const fs::path& folder() const { return folder_.path(); }
    void pull() const { write("/sys/block/" + name_ + "/device/delete", "1"); }

  private:
    static void write(const fs::path& file, const std::string& word) {
        std::ofstream(file) << word << std::flush;
    }
    bool is_found() {
        for (const auto& block : fs::directory_iterator("/sys/block")) {
            std::ifstream model(block.path() / "device/model");
            std::string name;
            std::getline(model, name);
            if (!name.starts_with("scsi_debug")) continue;
            name_ = block.path().filename();
            return fs::exists("/dev/" + name_);
        }
        return false;
    }

    TemporaryFolder folder_;
    std::string name_;
    bool is_there_ = false;
};

TEST(UnpluggedDisk, EndsTheTakeAndIsNamed) {
    const Disk disk;
    ASSERT_TRUE(disk.is_there());
    TakeRecorder::Settings settings;
    settings.rigs = {"north"};
    settings.pulse_rate_hz = 25;
    settings.disk_mb_s = [](const auto&) { return 1000.0; };
    TakeRecorder recorder(settings);
    const fs::path take = disk.folder() / "take.mkv";
    recorder.begin(take);
    std::jthread rig([&](const std::stop_token& stop) {
        for (std::uint64_t pulse = 1000; !stop.stop_requested(); ++pulse) {
            ArrivedFrame frame;
            frame.packed = std::make_shared<const PackedFrame>(sent_frame("north", pulse));
            frame.link.sent = pulse;
            recorder.offer(frame);
            std::this_thread::sleep_for(std::chrono::milliseconds(40));
        }
    });
    ASSERT_TRUE(eventually([&] { return recorder.state().frames > 50; }));
    disk.pull();
    ASSERT_TRUE(eventually([&] { return recorder.state().phase == TakePhase::failed; }))
        << recorder.state().bytes << " bytes";
    const std::string failure = recorder.state().failure;
    EXPECT_NE(failure.find(take.string()), std::string::npos) << failure;
    EXPECT_NE(failure.find("Input/output error"), std::string::npos) << failure;
    EXPECT_FALSE(recorder.is_running());
}

TEST(UnpluggedDisk, EndsTheFilmAndIsNamed) {
    const Disk disk;
    ASSERT_TRUE(disk.is_there());
    const fs::path film = disk.folder() / "film.mkv";
    const OutputPatience patience;
    const auto target =
        plan_output(film, {.width_px = 320, .height_px = 180, .rate_hz = 10}).open(patience);
    ColourImage picture(180, 320);
    std::int64_t tick = 0;
    const auto write = [&] {
        cv::randu(picture, 0, 256);  // many bytes
        target->write(picture, tick++, "");
    };
    while (tick < 20) write();
    disk.pull();
    std::string sentence;
    ASSERT_TRUE(eventually([&] { return !(sentence = thrown_sentence(write)).empty(); }));
    EXPECT_NE(sentence.find(film.string()), std::string::npos) << sentence;
    EXPECT_NE(sentence.find("Input/output error"), std::string::npos) << sentence;
}

}  // namespace
}  // namespace vantage
