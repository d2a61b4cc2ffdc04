#include <gtest/gtest.h>

#include "common/config/rig_config.h"
#include "rig_firmware/capture/stereo_source.h"
#include "rig_firmware/capture/v4l2/v4l2_camera.h"
#include "tests/support/data_folder.h"
#include "tests/support/thrown_sentence.h"

namespace vantage {
namespace {

TEST(V4l2Device, SaysWhatIsNoCamera) {
    EXPECT_NE(thrown_sentence([] { V4l2Device("/dev/video987654"); }).find("there is no camera at"),
              std::string::npos);
    EXPECT_NE(thrown_sentence([] { V4l2Device("/dev/null"); }).find("is not a video device"),
              std::string::npos);
    EXPECT_TRUE(stable_video_path("/dev/null").empty());
}

TEST(V4l2Source, WantsItsDevices) {
    RigConfig config;
    config.source.kind = "v4l2";
    EXPECT_NE(thrown_sentence([&] { make_source(config); }).find("'left_device'"),
              std::string::npos);
    config.source.left_device = config.source.right_device = "/dev/video0";
    EXPECT_NE(thrown_sentence([&] { make_source(config); }).find("name two cameras"),
              std::string::npos);
}

TEST(V4l2Camera, DeliversPicturesOfTheModeItWasAskedFor) {
    for (const std::filesystem::path& node : list_video_nodes()) {
        const V4l2Device device(node);
        if (!device.captures()) continue;
        const auto formats = device.formats();
        for (const V4l2Format& format : formats) {
            if (format.sizes.empty()) continue;
            const V4l2Size& size = format.sizes.front();
            V4l2Camera camera({.path = node,
                               .width_px = size.width_px,
                               .height_px = size.height_px,
                               .rate_hz = size.rates_hz.empty() ? 25 : size.rates_hz.front(),
                               .pixel_format = {},
                               .controls = {},
                               .share_buffers = true});
            std::optional<SensorPicture> picture;
            const MonotonicTime deadline = MonotonicClock::now() + std::chrono::seconds(10);
            while (!picture && MonotonicClock::now() < deadline) picture = camera.take();
            ASSERT_TRUE(picture) << node;
            EXPECT_EQ(picture->colour.size(), cv::Size(size.width_px, size.height_px));
            return;
        }
    }
    GTEST_SKIP() << "SKIPPED: this computer has no V4L2 camera that can be opened";
}

}  // namespace
}  // namespace vantage
