#include "rig_firmware/capture/v4l2/v4l2_camera.h"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <linux/videodev2.h>
#include <sys/mman.h>

#include "common/base/cli/nearest_name.h"
#include "common/base/error.h"
#include "common/base/log.h"

namespace vantage {
namespace {

std::string lower(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

MonotonicTime to_monotonic(const timeval& t) {
    return monotonic_from_ns((t.tv_sec * std::int64_t{1'000'000} + t.tv_usec) * 1000);
}

/// v4l2_buffer with room for one plane, for both the single-planar and the multi-planar API.
struct BufferRequest {
    v4l2_plane plane{};
    v4l2_buffer buffer{};

    BufferRequest(const V4l2Device& device, std::uint32_t index) {
        buffer.type = device.buffer_type();
        buffer.memory = V4L2_MEMORY_MMAP;
        buffer.index = index;
        if (!device.is_multiplanar()) return;
        buffer.m.planes = &plane;
        buffer.length = 1;
    }
    BufferRequest(const BufferRequest&) = delete;
    BufferRequest& operator=(const BufferRequest&) = delete;

    std::size_t length() const { return buffer.m.planes == &plane ? plane.length : buffer.length; }
    std::int64_t offset() const {
        return buffer.m.planes == &plane ? plane.m.mem_offset : buffer.m.offset;
    }
    std::size_t bytes_used() const {
        return buffer.m.planes == &plane ? plane.bytesused : buffer.bytesused;
    }
};

}  // namespace

V4l2Camera::Mapping::Mapping(int fd, std::size_t length, std::int64_t offset) : length_(length) {
    void* start = ::mmap(nullptr, length, PROT_READ | PROT_WRITE, MAP_SHARED, fd, offset);
    if (start != MAP_FAILED) start_ = static_cast<std::byte*>(start);
}

V4l2Camera::Mapping::~Mapping() {
    if (start_) ::munmap(start_, length_);
}

V4l2Camera::V4l2Camera(const V4l2Settings& request)
    : device_(request.path), lender_([this](unsigned index) { take_back(index); }) {
    if (!device_.captures())
        fail(
            "{} ('{}') delivers no pictures: it is another kind of video node, and `vantage-rig "
            "probe` lists the cameras",
            request.path.string(), device_.card());
    // An HDMI receiver adopts its sender's timings only on request; cameras have no such timings.
    v4l2_dv_timings timings{};
    if (device_.try_request(VIDIOC_QUERY_DV_TIMINGS, &timings))
        device_.try_request(VIDIOC_S_DV_TIMINGS, &timings);
    choose_format(request);
    set_rate(request.rate_hz);
    set_controls(request.controls);
    map_buffers(request.share_buffers);
    std::uint32_t type = device_.buffer_type();
    device_.request(VIDIOC_STREAMON, &type, "to start");
}

V4l2Camera::~V4l2Camera() {
    lender_.close();
    try {
        std::uint32_t type = device_.buffer_type();
        device_.try_request(VIDIOC_STREAMOFF, &type);
    } catch (const DeviceLost&) {
        log_debug("{} is gone already", device_.path().string());
    }
}

bool V4l2Camera::set_format(PixelFormat format, const V4l2Settings& request, bool only_try,
                            cv::Size& offered) {
    v4l2_format f{};
    f.type = device_.buffer_type();
    const auto width = static_cast<std::uint32_t>(request.width_px);
    const auto height = static_cast<std::uint32_t>(request.height_px);
    const bool planar = device_.is_multiplanar();
    if (planar) {
        f.fmt.pix_mp.width = width;
        f.fmt.pix_mp.height = height;
        f.fmt.pix_mp.pixelformat = fourcc_of(format);
        f.fmt.pix_mp.field = V4L2_FIELD_NONE;
        f.fmt.pix_mp.num_planes = 1;
    } else {
        f.fmt.pix.width = width;
        f.fmt.pix.height = height;
        f.fmt.pix.pixelformat = fourcc_of(format);
        f.fmt.pix.field = V4L2_FIELD_NONE;
    }
    if (only_try) {
        if (!device_.try_request(VIDIOC_TRY_FMT, &f)) return false;
    } else {
        device_.request(VIDIOC_S_FMT, &f, "its picture format");
    }
    const std::uint32_t got_format = planar ? f.fmt.pix_mp.pixelformat : f.fmt.pix.pixelformat;
    const std::uint32_t got_width = planar ? f.fmt.pix_mp.width : f.fmt.pix.width;
    const std::uint32_t got_height = planar ? f.fmt.pix_mp.height : f.fmt.pix.height;
    const bool one_plane = !planar || f.fmt.pix_mp.num_planes == 1;
    offered = {static_cast<int>(got_width), static_cast<int>(got_height)};
    if (got_format != fourcc_of(format) || got_width != width || got_height != height || !one_plane)
        return false;
    mode_.format = format;
    mode_.width_px = request.width_px;
    mode_.height_px = request.height_px;
    mode_.bytes_per_line = planar ? f.fmt.pix_mp.plane_fmt[0].bytesperline : f.fmt.pix.bytesperline;
    return true;
}

void V4l2Camera::choose_format(const V4l2Settings& request) {
    std::vector<PixelFormat> candidates;
    std::string listed;
    const std::vector<V4l2Format> formats = device_.formats();
    for (const V4l2Format& format : formats)
        listed += fmt::format("{}'{}'", listed.empty() ? "" : ", ", fourcc_text(format.fourcc));
    for (const PixelFormat known : known_pixel_formats()) {
        const bool has = std::any_of(formats.begin(), formats.end(), [&](const V4l2Format& format) {
            return format.fourcc == fourcc_of(known);
        });
        if (has &&
            (request.pixel_format.empty() || parse_pixel_format(request.pixel_format) == known))
            candidates.push_back(known);
    }
    if (candidates.empty())
        fail("the camera {} has no picture format that {}; it offers {}", request.path.string(),
             request.pixel_format.empty() ? "is understood"
                                          : fmt::format("is '{}'", request.pixel_format),
             listed.empty() ? "none" : listed);
    cv::Size offered, ignored;
    for (const PixelFormat candidate : candidates) {
        if (!set_format(candidate, request, true, offered)) continue;
        if (set_format(candidate, request, false, ignored)) return;
    }
    fail("the camera {} offers no pictures of {}x{}; the nearest is {}x{}", request.path.string(),
         request.width_px, request.height_px, offered.width, offered.height);
}

void V4l2Camera::set_rate(double rate_hz) {
    v4l2_streamparm parameters{};
    parameters.type = device_.buffer_type();
    v4l2_fract& period = parameters.parm.capture.timeperframe;
    constexpr double millihertz = 1000;
    period.numerator = static_cast<std::uint32_t>(millihertz);
    period.denominator = static_cast<std::uint32_t>(std::lround(rate_hz * millihertz));
    if (device_.try_request(VIDIOC_S_PARM, &parameters) && period.numerator > 0)
        mode_.rate_hz = static_cast<double>(period.denominator) / period.numerator;
}

void V4l2Camera::set_controls(const std::map<std::string, int>& requests) {
    const std::vector<V4l2Control> controls = device_.controls();
    std::vector<std::string> names;
    for (const V4l2Control& control : controls) names.push_back(control.name);
    std::vector<std::pair<V4l2Control, int>> settings;
    for (const auto& [name, value] : requests) {
        const auto found = std::find_if(
            controls.begin(), controls.end(),
            [&](const V4l2Control& control) { return lower(control.name) == lower(name); });
        if (found == controls.end())
            fail("the camera {} has no control '{}'; {}", device_.path().string(), name,
                 suggest_name(name, names));
        if (!found->is_writable)
            fail("the control '{}' of the camera {} can only be read", found->name,
                 device_.path().string());
        if (value < found->least || value > found->most)
            fail("the control '{}' of the camera {} takes {} to {}, and {} is given", found->name,
                 device_.path().string(), found->least, found->most, value);
        settings.emplace_back(*found, value);
    }
    // Drivers refuse a manual value while its automatic control is on. Settings that were refused
    // are tried again after all others.
    std::vector<std::pair<V4l2Control, int>> again;
    for (const auto& [control, value] : settings) {
        v4l2_control wanted{.id = control.id, .value = value};
        if (!device_.try_request(VIDIOC_S_CTRL, &wanted)) again.emplace_back(control, value);
    }
    for (const auto& [control, value] : again) device_.set_control(control, value);
}

void V4l2Camera::map_buffers(bool share_them) {
    v4l2_requestbuffers wanted{};
    wanted.count = BufferLender::wanted_buffers;
    wanted.type = device_.buffer_type();
    wanted.memory = V4L2_MEMORY_MMAP;
    device_.request(VIDIOC_REQBUFS, &wanted, "buffers to map");
    if (wanted.count < 2)
        fail("the camera {} gives {} buffers, and 2 are needed at least", device_.path().string(),
             wanted.count);
    for (std::uint32_t i = 0; i < wanted.count; ++i) {
        BufferRequest request(device_, i);
        device_.request(VIDIOC_QUERYBUF, &request.buffer, "to describe a buffer");
        const auto mapping =
            std::make_shared<Mapping>(device_.fd(), request.length(), request.offset());
        if (!mapping->is_mapped())
            fail("a buffer of {} bytes of the camera {} cannot be mapped: {}", request.length(),
                 device_.path().string(), std::strerror(errno));
        if (share_them) mapping->dma_buf = share(i);
        buffers_.push_back(mapping);
        queue(i);
    }
}

UniqueFd V4l2Camera::share(std::uint32_t index) const {
    v4l2_exportbuffer request{};
    request.type = device_.buffer_type();
    request.index = index;
    request.flags = O_RDWR | O_CLOEXEC;
    return device_.try_request(VIDIOC_EXPBUF, &request) ? UniqueFd(request.fd) : UniqueFd();
}

std::optional<LentPicture> V4l2Camera::specimen() const {
    if (mode_.format == PixelFormat::mjpg || buffers_.size() < BufferLender::least_buffers)
        return std::nullopt;
    return lent(0, buffers_[0]->bytes());
}

void V4l2Camera::lend() { lends_ = specimen().has_value(); }

LentPicture V4l2Camera::lent(std::uint32_t index, std::span<const std::byte> bytes) const {
    return {.raw = {.format = mode_.format,
                    .width_px = mode_.width_px,
                    .height_px = mode_.height_px,
                    .bytes_per_line = mode_.bytes_per_line,
                    .bytes = bytes},
            .view = {0, 0, mode_.width_px, mode_.height_px},
            .dma_buf = buffers_.at(index)->dma_buf.get(),
            .offset = 0,
            .camera = lender_.identity(),
            .index = index,
            .lease = {}};
}

void V4l2Camera::take_back(std::uint32_t index) noexcept {
    try {
        queue(index);
    } catch (const std::exception& error) {
        // The next take() meets and reports the same error.
        log_debug("{}", error.what());
    }
}

void V4l2Camera::queue(std::uint32_t index) {
    BufferRequest request(device_, index);
    device_.request(VIDIOC_QBUF, &request.buffer, "to take back a buffer");
}

std::optional<SensorPicture> V4l2Camera::take() {
    for (;;) {
        BufferRequest request(device_, 0);
        if (!device_.try_request(VIDIOC_DQBUF, &request.buffer)) {
            if (errno == EAGAIN) return std::nullopt;
            throw DeviceLost(fmt::format("the camera {} stopped: {}", device_.path().string(),
                                         std::strerror(errno)));
        }
        const v4l2_buffer& buffer = request.buffer;
        const bool is_monotonic =
            (buffer.flags & V4L2_BUF_FLAG_TIMESTAMP_MASK) == V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC;
        SensorPicture picture{
            .sequence = buffer.sequence,
            .time = is_monotonic ? to_monotonic(buffer.timestamp) : MonotonicClock::now(),
            .colour = {},
            .lent = {}};
        const std::span<const std::byte> all = buffers_.at(buffer.index)->bytes();
        const bool is_faulty = (buffer.flags & V4L2_BUF_FLAG_ERROR) != 0;
        try {
            if (!is_faulty) {
                LentPicture whole =
                    lent(buffer.index, all.first(std::min(request.bytes_used(), all.size())));
                if (lends_) {
                    (void)planes_of(whole.raw);
                    whole.lease = lender_.lend(buffer.index, buffers_[buffer.index]);
                    picture.lent = std::move(whole);
                    return picture;
                }
                picture.colour = to_colour(whole.raw);
            }
        } catch (const Error& error) {
            // One damaged frame is an error of the camera or the cable, and the stream continues.
            log_debug("{}: {}", device_.path().string(), error.what());
        }
        queue(buffer.index);
        if (!picture.colour.empty()) return picture;
        ++damaged_;
    }
}

std::vector<std::string> V4l2Camera::report() const {
    const std::string rate = mode_.rate_hz > 0 ? fmt::format("{:.4g} Hz", mode_.rate_hz)
                                               : std::string("a rate the driver does not tell");
    std::vector<std::string> lines = {
        fmt::format("{} ('{}' on {}): {}x{} {} at {}, {} mapped buffers, {}",
                    device_.path().string(), device_.card(), device_.bus(), mode_.width_px,
                    mode_.height_px, fourcc_text(fourcc_of(mode_.format)), rate, buffers_.size(),
                    !specimen()            ? "every picture is converted on the processor"
                    : buffers_[0]->dma_buf ? "shared as dma-bufs"
                                           : "not shared")};
    for (const AutomaticControl& automatic : automatics_of(device_))
        lines.push_back(
            automatic.is_fixed
                ? fmt::format("{}: {} is fixed", device_.path().string(), automatic.what)
                : fmt::format("{}: {} is AUTOMATIC and will differ between cameras: fix it "
                              "with \"{}\" = {} in [source.controls]",
                              device_.path().string(), automatic.what, automatic.control,
                              automatic.fixed_value));
    return lines;
}

}  // namespace vantage
