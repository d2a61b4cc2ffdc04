#include <thread>

#include <gtest/gtest.h>
#include <poll.h>

#include "host_app/output/output.h"
#include "rig_firmware/capture/v4l2/v4l2_camera.h"
#include "tests/hil/devices/vivid_loop.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;

const cv::Size size(640, 480);
/// Vivid's output node, and the capture node that it is looped to.
constexpr const char* output_node = "/dev/video11";
constexpr const char* capture_node = "/dev/video10";

/// Three bars of a colour each.
ProgrammePicture bars(std::uint64_t tick) {
    ProgrammePicture picture;
    picture.tick = tick;
    picture.picture = ColourImage(size, cv::Vec4b(200, 40, 40, 255));
    picture.picture.colRange(200, 400) = cv::Vec4b(40, 180, 60, 255);
    picture.picture.colRange(400, 640) = cv::Vec4b(50, 60, 220, 255);
    return picture;
}

bool is_like(const cv::Vec4b& seen, const cv::Vec4b& sent) {
    // YUYV of one side by BT.709, of the other by BT.601: the hue is what is looked at.
    for (int i = 0; i < 3; ++i)
        if (std::abs(seen[i] - sent[i]) > 45) return false;
    return true;
}

class V4l2OutputTest : public testing::Test {
  protected:
    V4l2OutputTest() {
        {
            const V4l2Device capture(capture_node), sink(output_node);
            loop_vivid(capture);
            set_vivid_timings(capture, size);
            set_vivid_timings(sink, size);
        }
        output_.emplace(plan_output(std::string("v4l2:") + output_node, format_), format_, 25);
        output_->start();
        feeder_ = std::jthread([this](const std::stop_token& stop) {
            for (std::uint64_t tick = 0; !stop.stop_requested(); ++tick) {
                output_->take(bars(tick));
                std::this_thread::sleep_for(20ms);
            }
        });
    }
    ~V4l2OutputTest() override { feeder_.request_stop(); }

    OutputFormat format_{.width_px = size.width, .height_px = size.height, .rate_hz = 50};
    std::optional<Output> output_;
    std::jthread feeder_;
};

TEST_F(V4l2OutputTest, AProgramThatReadsTheDeviceSeesTheProgramme) {
    V4l2Camera camera({.path = capture_node,
                       .width_px = size.width,
                       .height_px = size.height,
                       .pixel_format = "YUYV",
                       .controls = {}});
    // The first pictures may be vivid's own noise, of before anything came.
    bool is_seen = false;
    cv::Vec4b seen[3];
    for (int i = 0; i < 100 && !is_seen; ++i) {
        pollfd wait{.fd = camera.fd(), .events = POLLIN, .revents = 0};
        ::poll(&wait, 1, 1000);
        const auto picture = camera.take();
        if (!picture) continue;
        const ColourImage sent = bars(0).picture;
        is_seen = true;
        for (int bar = 0; bar < 3; ++bar) {
            const cv::Point at(100 + 200 * bar, 240);
            seen[bar] = picture->colour(at);
            is_seen = is_seen && is_like(seen[bar], sent(at));
        }
    }
    EXPECT_TRUE(is_seen) << cv::Mat(1, 3, CV_8UC4, seen);
    const OutputState state = output_->state();
    EXPECT_EQ(state.phase, OutputPhase::on) << state.failure;
    EXPECT_GT(state.pictures, 0u);
    EXPECT_EQ(state.failures, 0u);
    std::printf("hil: v4l2 output %llu pictures\n",
                static_cast<unsigned long long>(state.pictures));
}

TEST_F(V4l2OutputTest, ASizeThatTheDeviceDoesNotTakeIsNamed) {
    const OutputFormat small{.width_px = 320, .height_px = 180, .rate_hz = 25};
    output_->finish();
    Output output(plan_output(std::string("v4l2:") + output_node, small), small, 25);
    output.start();
    for (int i = 0; i < 5000 && output.state().phase != OutputPhase::failed; ++i)
        std::this_thread::sleep_for(2ms);
    EXPECT_NE(output.state().failure.find("640x480 and not of 320x180"), std::string::npos)
        << output.state().failure;
    output.finish();
}

}  // namespace
}  // namespace vantage
