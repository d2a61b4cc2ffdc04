#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "common/base/error.h"
#include "common/config/calibration_file.h"
#include "rig_firmware/capture/rig_calibration.h"
#include "tests/hil/devices/rig_process.h"
#include "tests/support/eventually.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;

/// vivid as a whole, taken from its driver and given back.
void set_bound(bool bound) {
    std::ofstream file(std::string("/sys/bus/platform/drivers/vivid/") +
                       (bound ? "bind" : "unbind"));
    file << "vivid.0" << std::flush;
    if (!file) fail("vivid cannot be {}", bound ? "bound" : "unbound");
}

bool eventually_logs(const RigProcess& rig, const std::string& sentence) {
    return eventually([&] { return rig.log().find(sentence) != std::string::npos; }, 10min, 100ms);
}

TEST(V4l2Unplugged, CameraIsUsedAgainByTheSameDaemonWhenItIsBack) {
    const TemporaryFolder folder;
    const std::string calibration = (folder.path() / "rig.yaml").string();
    save_calibration(calibration, ideal_rig(RigConfig{}, {160, 180}), {});
    RigProcess rig("calibration = \"" + calibration +
                   "\"\n[source]\nkind = \"v4l2\"\nrate_hz = 2\nwidth_px = 160\nheight_px = 180\n"
                   "left_device = \"/dev/video14\"\nside_by_side = true\npixel_format = \"NV12\"\n"
                   "[match]\npreset = \"fast\"\ndisparities = 16\nsteady = false\n");
    const auto before = rig.next_frame();
    set_bound(false);
    EXPECT_TRUE(eventually_logs(rig, "frames are missed until the cameras deliver again"));
    EXPECT_FALSE(std::filesystem::exists("/dev/video14"));
    std::this_thread::sleep_for(3s);
    set_bound(true);
    EXPECT_TRUE(eventually_logs(rig, "the cameras deliver again\n")) << rig.log();
    const TaiTime back = TaiClock::now();
    std::shared_ptr<const RigFrame> frame;
    do {
        frame = rig.next_frame();
    } while (frame->exposure < back);
    EXPECT_EQ(frame->session, before->session);
    const nlohmann::json summary = nlohmann::json::parse(rig.stop());
    std::printf("hil: unplugged %s\n", summary.dump().c_str());
    EXPECT_EQ(summary["source"]["reopened"], 1) << summary;
    EXPECT_GE(summary["missed"], 6) << "three seconds at 2 Hz: " << summary;
    EXPECT_GT(summary["source"]["copied_pictures"], 1) << summary;
}

}  // namespace
}  // namespace vantage
