#include <chrono>
#include <fstream>
#include <string>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <opencv2/imgproc.hpp>

#include "common/base/error.h"
#include "common/config/calibration_file.h"
#include "common/image/image_file.h"
#include "rig_firmware/capture/pixel_conversion.h"
#include "rig_firmware/capture/rig_calibration.h"
#include "tests/hil/devices/rig_process.h"
#include "tests/hil/usb_camera/yuyv_picture.h"
#include "tests/support/data_folder.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

const cv::Size sensor_size(320, 240);

/// What a USB camera of the tests shows, as the rig has it in memory.
ColourImage seen(const std::filesystem::path& file) {
    const cv::Mat2b picture = yuyv_picture(file, sensor_size);
    return to_colour({.format = PixelFormat::yuyv,
                      .width_px = picture.cols,
                      .height_px = picture.rows,
                      .bytes_per_line = 0,
                      .bytes = std::as_bytes(std::span(picture.data, picture.total() * 2))});
}

/// Two USB cameras that see teddy, on the ports 1 (left) and 2 of one controller.
class TeddyOnUsb : public testing::Test {
  protected:
    void SetUp() override {
        VANTAGE_REQUIRE_DATA(data);
        write_colour_image(file("left.png"), seen(data / "middlebury2003/teddy/im2.png"));
        write_colour_image(file("right.png"), seen(data / "middlebury2003/teddy/im6.png"));
        save_calibration(file("rig.yaml"), ideal_rig(RigConfig{}, sensor_size), {});
    }

    std::string file(const std::string& name) const { return (folder_.path() / name).string(); }
    std::string parts(const std::string& source) const {
        return "calibration = \"" + file("rig.yaml") + "\"\n[source]\n" + source +
               "width_px = 320\nheight_px = 240\n[match]\npreset = \"fast\"\ndisparities = 16\n";
    }
    std::string files_source() const {
        return "kind = \"files\"\nrate_hz = 2\nleft = \"" + file("left.png") + "\"\nright = \"" +
               file("right.png") + "\"\n";
    }
    static std::string cameras_source(const std::string& left = "*-1:1.0-1209:ca01") {
        return "kind = \"libcamera\"\nrate_hz = 5\nleft_device = \"" + left +
               "\"\nright_device = \"*-2:1.0-1209:ca01\"\n";
    }

    TemporaryFolder folder_;
};

/// Takes the camera on a port from its bus, or gives it back.
void set_plugged(int port, bool plugged) {
    for (const auto& entry : std::filesystem::directory_iterator("/sys/bus/usb/devices")) {
        const std::string name = entry.path().filename().string();
        if (!name.ends_with("-" + std::to_string(port))) continue;
        std::ifstream vendor(entry.path() / "idVendor");
        std::string id;
        if (!(vendor >> id) || id != "1209") continue;
        std::ofstream(entry.path() / "authorized") << (plugged ? "1" : "0") << std::flush;
        return;
    }
    fail("there is no test camera on USB port {}", port);
}

TEST_F(TeddyOnUsb, HasTheDisparityThatTheFilesHave) {
    DisparityImage from_files;
    {
        RigProcess rig(parts(files_source()));
        from_files = rig.next_frame()->disparity;
    }
    EXPECT_GT(cv::countNonZero(from_files), static_cast<int>(from_files.total() / 4));
    RigProcess rig(parts(cameras_source()));
    EXPECT_EQ(cv::norm(rig.next_frame()->disparity, from_files, cv::NORM_L1), 0);
    // With few buffers a camera keeps them.
    EXPECT_THAT(rig.log(),
                testing::AnyOf(HasSubstr("every picture is copied to the GPU"),
                               HasSubstr("every picture is converted on the processor")));

    // Unplugged and plugged in again: the same daemon goes on by itself.
    const auto session = rig.next_frame()->session;
    set_plugged(1, false);
    for (int i = 0; i < 600 && rig.log().find("frames are missed until") == std::string::npos; ++i)
        std::this_thread::sleep_for(100ms);
    EXPECT_THAT(rig.log(), HasSubstr("frames are missed until the cameras deliver again"));
    set_plugged(1, true);
    for (int i = 0; i < 600 && rig.log().find("the cameras deliver again\n") == std::string::npos;
         ++i)
        std::this_thread::sleep_for(100ms);
    // A picture may be torn where the plug was pulled: what is averaged along time gets over it in
    // some frames.
    constexpr int most_frames = 100;
    const auto off = [&](const DisparityImage& seen) {
        return cv::norm(seen, from_files, cv::NORM_L1);
    };
    std::shared_ptr<const RigFrame> frame;
    const TaiTime plugged_in = TaiClock::now();
    for (int looked = 0; looked < most_frames; ++looked) {
        frame = rig.next_frame();
        if (frame->exposure >= plugged_in && off(frame->disparity) == 0) break;
    }
    EXPECT_GE(frame->exposure, plugged_in) << rig.log();
    EXPECT_EQ(frame->session, session) << rig.log();
    EXPECT_EQ(off(frame->disparity), 0) << rig.log();
    const nlohmann::json summary = nlohmann::json::parse(rig.stop());
    EXPECT_GE(summary["source"]["reopened"], 1) << summary;
    EXPECT_GT(summary["source"]["copied_pictures"], 4) << summary;
}

/// Once only: libcamera (0.3 to 0.7) ends the process now and then if a camera goes while a buffer
/// is on its way to it, which no caller can prevent; a service starts the rig again.
TEST_F(TeddyOnUsb, OnOneHubThatIsUnpluggedAreUsedAgain) {
    RigProcess rig(parts(cameras_source()));
    const auto session = rig.next_frame()->session;
    for (const int port : {1, 2}) set_plugged(port, false);
    for (const int port : {1, 2}) set_plugged(port, true);
    const TaiTime plugged_in = TaiClock::now();
    std::shared_ptr<const RigFrame> frame;
    do frame = rig.next_frame();
    while (frame->exposure < plugged_in);
    EXPECT_EQ(frame->session, session) << rig.log();
    const nlohmann::json summary = nlohmann::json::parse(rig.stop());
    EXPECT_GE(summary["source"]["reopened"], 1) << summary << rig.log();
}

TEST_F(TeddyOnUsb, AreListedWhenNoneHasTheName) {
    const std::string config = file("rig.toml");
    std::ofstream(config) << "version = 1\nname = \"rig\"\n" << parts(cameras_source("imx296*"));
    const ProgramResult result = run_to_end(VANTAGE_RIG_PROGRAM, {"run", "--config", config});
    EXPECT_EQ(result.status, 1);
    EXPECT_THAT(result.err, HasSubstr("libcamera has no camera 'imx296*'"));
    EXPECT_THAT(result.err, HasSubstr("1209:ca01"));
}

}  // namespace
}  // namespace vantage
