#include "tests/hil/devices/vivid_loop.h"

#include <chrono>
#include <cstring>

#include <linux/videodev2.h>
#include <poll.h>
#include <sys/mman.h>

namespace vantage {
namespace {

constexpr std::uint32_t buffers = 3;
constexpr double most_hz = 61;

void set_timings(const V4l2Device& device, const cv::Size& size) {
    v4l2_enum_dv_timings listed{};
    for (; device.try_request(VIDIOC_ENUM_DV_TIMINGS, &listed); ++listed.index) {
        const v4l2_bt_timings& timings = listed.timings.bt;
        const double frame_px = static_cast<double>(V4L2_DV_BT_FRAME_WIDTH(&timings)) *
                                static_cast<double>(V4L2_DV_BT_FRAME_HEIGHT(&timings));
        if (cv::Size(static_cast<int>(timings.width), static_cast<int>(timings.height)) != size ||
            timings.interlaced || static_cast<double>(timings.pixelclock) / frame_px > most_hz)
            continue;
        device.request(VIDIOC_S_DV_TIMINGS, &listed.timings, "set the timings");
        return;
    }
    fail("{} has no timings for {}x{}", device.path().string(), size.width, size.height);
}

void set_grey(const V4l2Device& device, v4l2_buf_type type, const cv::Size& size) {
    v4l2_format format{};
    format.type = type;
    device.request(VIDIOC_G_FMT, &format, "get the format");
    format.fmt.pix.width = static_cast<std::uint32_t>(size.width);
    format.fmt.pix.height = static_cast<std::uint32_t>(size.height);
    format.fmt.pix.pixelformat = V4L2_PIX_FMT_GREY;
    format.fmt.pix.field = V4L2_FIELD_NONE;
    format.fmt.pix.bytesperline = 0;  // else the stride of the format before stays
    format.fmt.pix.sizeimage = 0;
    device.request(VIDIOC_S_FMT, &format, "set the format");
}

void set_control(const V4l2Device& device, const std::string& name, int value) {
    for (const V4l2Control& control : device.controls())
        if (control.name == name) return device.set_control(control, value);
    fail("{} has no control '{}'", device.path().string(), name);
}

v4l2_buffer output_buffer(std::uint32_t index = 0) {
    v4l2_buffer buffer{};
    buffer.type = V4L2_BUF_TYPE_VIDEO_OUTPUT;
    buffer.memory = V4L2_MEMORY_MMAP;
    buffer.index = index;
    buffer.field = V4L2_FIELD_NONE;
    return buffer;
}

}  // namespace

VividLoop::VividLoop(const std::filesystem::path& capture, const std::filesystem::path& output,
                     const cv::Mat& picture)
    : output_(output) {
    {
        const V4l2Device sensor(capture);
        set_control(sensor, "Loop Video", 1);
        set_control(sensor, "OSD Text Mode", 2);
        set_timings(sensor, picture.size());
        set_grey(sensor, V4L2_BUF_TYPE_VIDEO_CAPTURE, picture.size());
    }
    set_timings(output_, picture.size());
    set_grey(output_, V4L2_BUF_TYPE_VIDEO_OUTPUT, picture.size());
    show(picture);
    feeder_ = std::jthread([this](const std::stop_token& stop) { feed(stop); });
}

VividLoop::~VividLoop() {
    feeder_.request_stop();
    feeder_.join();
}

void VividLoop::show(const cv::Mat& picture) {
    v4l2_requestbuffers request{};
    request.count = buffers;
    request.type = V4L2_BUF_TYPE_VIDEO_OUTPUT;
    request.memory = V4L2_MEMORY_MMAP;
    output_.request(VIDIOC_REQBUFS, &request, "get buffers");
    for (std::uint32_t index = 0; index < request.count; ++index) {
        v4l2_buffer buffer = output_buffer(index);
        output_.request(VIDIOC_QUERYBUF, &buffer, "look at a buffer");
        void* memory =
            ::mmap(nullptr, buffer.length, PROT_WRITE, MAP_SHARED, output_.fd(), buffer.m.offset);
        if (memory == MAP_FAILED) fail("{} maps no buffer", output_.path().string());
        const cv::Mat grey = picture.isContinuous() ? picture : picture.clone();
        std::memcpy(memory, grey.data, grey.total());
        ::munmap(memory, buffer.length);
        buffer = output_buffer(index);
        buffer.bytesused = static_cast<std::uint32_t>(grey.total());
        output_.request(VIDIOC_QBUF, &buffer, "queue a buffer");
    }
    int type = V4L2_BUF_TYPE_VIDEO_OUTPUT;
    output_.request(VIDIOC_STREAMON, &type, "start");
}

void VividLoop::feed(const std::stop_token& stop) const {
    while (!stop.stop_requested()) {
        pollfd wait{.fd = output_.fd(), .events = POLLOUT, .revents = 0};
        constexpr int slice_ms = 100;
        if (::poll(&wait, 1, slice_ms) <= 0) continue;
        try {
            v4l2_buffer buffer = output_buffer();
            if (!output_.try_request(VIDIOC_DQBUF, &buffer)) continue;
            const std::uint32_t bytes = buffer.bytesused;
            buffer = output_buffer(buffer.index);
            buffer.bytesused = bytes;
            output_.request(VIDIOC_QBUF, &buffer, "queue a buffer");
        } catch (const DeviceLost&) {
            return;
        }
    }
}

}  // namespace vantage
