#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <linux/videodev2.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include "common/base/error.h"
#include "common/base/files/unique_fd.h"
#include "common/base/time/pulse_grid.h"
#include "host_app/output/media/picture_encoder.h"
#include "host_app/output/output_target.h"

namespace vantage {
namespace {

struct PixelLayout {
    std::uint32_t v4l2;
    AVPixelFormat av;
};
/// Pixel formats of devices, most common first.
constexpr std::array<PixelLayout, 4> layouts{{{V4L2_PIX_FMT_YUYV, AV_PIX_FMT_YUYV422},
                                              {V4L2_PIX_FMT_UYVY, AV_PIX_FMT_UYVY422},
                                              {V4L2_PIX_FMT_RGB24, AV_PIX_FMT_RGB24},
                                              {V4L2_PIX_FMT_RGBX32, AV_PIX_FMT_RGB0}}};

/// V4L2 output device that takes frames by write(): v4l2loopback, or an output of a card.
class V4l2Target final : public OutputTarget {
  public:
    V4l2Target(std::string device, const OutputFormat& format, const OutputPatience& patience)
        : device_(std::move(device)),
          fd_(::open(device_.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC)),
          patience_(patience) {
        if (fd_.get() < 0) fail("{} cannot be opened: {}", device_, std::strerror(errno));
        v4l2_capability facts{};
        if (::ioctl(fd_.get(), VIDIOC_QUERYCAP, &facts) != 0) fail("{} is no V4L2 device", device_);
        const std::uint32_t can =
            facts.capabilities & V4L2_CAP_DEVICE_CAPS ? facts.device_caps : facts.capabilities;
        if (!(can & V4L2_CAP_VIDEO_OUTPUT) || !(can & V4L2_CAP_READWRITE))
            fail("{} takes no pictures: it is no output, or takes none by write()", device_);
        set_format(format);
        set_rate(format.rate_hz);
    }

    void write(const ColourImage& picture, std::int64_t, const std::string&) override {
        const AVFrame& frame = converter_->convert(picture);
        const std::size_t stride = pixels_.bytesperline;
        const std::size_t row = std::min(stride, static_cast<std::size_t>(frame.linesize[0]));
        for (std::uint32_t y = 0; y < pixels_.height; ++y)
            std::copy_n(frame.data[0] + y * static_cast<std::size_t>(frame.linesize[0]), row,
                        packed_.data() + y * stride);
        while (!try_to_send())
            if (patience_.is_over()) fail("{} takes no picture", device_);
        bytes_ += packed_.size();
    }
    std::uint64_t bytes() const override { return bytes_; }

  private:
    void set_format(const OutputFormat& format) {
        for (const PixelLayout& layout : layouts) {
            v4l2_format request{};
            request.type = V4L2_BUF_TYPE_VIDEO_OUTPUT;
            request.fmt.pix.width = static_cast<std::uint32_t>(format.width_px);
            request.fmt.pix.height = static_cast<std::uint32_t>(format.height_px);
            request.fmt.pix.pixelformat = layout.v4l2;
            request.fmt.pix.field = V4L2_FIELD_NONE;
            request.fmt.pix.colorspace = V4L2_COLORSPACE_REC709;
            if (::ioctl(fd_.get(), VIDIOC_S_FMT, &request) != 0 ||
                request.fmt.pix.pixelformat != layout.v4l2)
                continue;
            pixels_ = request.fmt.pix;
            if (pixels_.width != static_cast<std::uint32_t>(format.width_px) ||
                pixels_.height != static_cast<std::uint32_t>(format.height_px))
                fail(
                    "{} takes pictures of {}x{} and not of {}x{}: give the programme that --size, "
                    "or the device that format",
                    device_, pixels_.width, pixels_.height, format.width_px, format.height_px);
            converter_.emplace(format.width_px, format.height_px, layout.av);
            // sizeimage is not used, since it may be rounded up to whole pages, and readers reject
            // longer frames.
            packed_.assign(std::size_t{pixels_.bytesperline} * pixels_.height, 0);
            return;
        }
        fail("{} takes none of the formats YUYV, UYVY, RGB24, RGBX", device_);
    }

    /// Sets the frame rate that readers of the device see; some devices have none.
    void set_rate(double rate_hz) const {
        const PulseGrid::Fraction rate = PulseGrid(rate_hz).rate();
        v4l2_streamparm request{};
        request.type = V4L2_BUF_TYPE_VIDEO_OUTPUT;
        request.parm.output.timeperframe = {static_cast<std::uint32_t>(rate.seconds),
                                            static_cast<std::uint32_t>(rate.pulses)};
        (void)::ioctl(fd_.get(), VIDIOC_S_PARM, &request);
    }

    bool try_to_send() const {
        const ssize_t wrote = ::write(fd_.get(), packed_.data(), packed_.size());
        if (wrote >= 0) return true;
        if (errno != EAGAIN && errno != EINTR)
            fail("{} breaks off: {}", device_, std::strerror(errno));
        constexpr int look_ms = 50;
        pollfd room{.fd = fd_.get(), .events = POLLOUT, .revents = 0};
        (void)::poll(&room, 1, look_ms);
        return false;
    }

    std::string device_;
    UniqueFd fd_;
    const OutputPatience& patience_;
    v4l2_pix_format pixels_{};
    std::optional<PictureConverter> converter_;
    std::vector<std::uint8_t> packed_;
    std::uint64_t bytes_ = 0;
};

OutputPlan plan(const OutputUrl& url, const OutputFormat& format) {
    url.require_options_of({});
    if (!url.place.starts_with('/'))
        fail("the output {}: behind v4l2: stands a device, such as /dev/video10", url.shown);
    return {.name = url.shown,
            .is_stream = true,
            .is_encoded = false,
            .open = [device = url.place, format](const OutputPatience& patience) {
                return std::make_unique<V4l2Target>(device, format, patience);
            }};
}

}  // namespace

OutputEntry v4l2_output_entry() {
    return {"v4l2", "v4l2:/dev/videoN (a loopback device, or a card's output)", plan};
}

}  // namespace vantage
