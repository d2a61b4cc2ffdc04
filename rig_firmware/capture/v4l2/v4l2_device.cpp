#include "rig_firmware/capture/v4l2/v4l2_device.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <string_view>

#include <fcntl.h>
#include <linux/videodev2.h>
#include <sys/ioctl.h>

#include "rig_firmware/capture/camera_access.h"

namespace vantage {
namespace {

bool means_gone(int reason) { return reason == ENODEV || reason == ENXIO; }

template <std::size_t n>
std::string text_of(const __u8 (&bytes)[n]) {
    const char* text = reinterpret_cast<const char*>(bytes);
    return {text, strnlen(text, n)};
}

int node_number(const std::filesystem::path& node) {
    constexpr std::string_view prefix = "video";
    const std::string name = node.filename().string();
    int number = -1;
    if (name.starts_with(prefix))
        std::from_chars(name.data() + prefix.size(), name.data() + name.size(), number);
    return number;
}

bool is_numeric(std::uint32_t type) {
    return type == V4L2_CTRL_TYPE_INTEGER || type == V4L2_CTRL_TYPE_BOOLEAN ||
           type == V4L2_CTRL_TYPE_MENU || type == V4L2_CTRL_TYPE_INTEGER_MENU;
}

}  // namespace

V4l2Device::V4l2Device(const std::filesystem::path& path) : path_(path) {
    fd_ = UniqueFd(::open(path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC));
    if (!fd_) {
        const int reason = errno;
        if (reason == ENOENT || means_gone(reason))
            throw DeviceLost(
                fmt::format("there is no camera at {}: `vantage-rig probe` lists those there are",
                            path.string()));
        if (reason == EACCES) fail("{}", camera_access_sentence(path));
        fail("cannot open {}: {}", path.string(), std::strerror(reason));
    }
    v4l2_capability capability{};
    if (!try_request(VIDIOC_QUERYCAP, &capability)) fail("{} is not a video device", path.string());
    card_ = text_of(capability.card);
    bus_ = text_of(capability.bus_info);
    capabilities_ = (capability.capabilities & V4L2_CAP_DEVICE_CAPS) ? capability.device_caps
                                                                     : capability.capabilities;
}

bool V4l2Device::captures() const {
    return (capabilities_ & (V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_VIDEO_CAPTURE_MPLANE)) != 0 &&
           (capabilities_ & V4L2_CAP_STREAMING) != 0;
}

bool V4l2Device::is_multiplanar() const {
    return (capabilities_ & V4L2_CAP_VIDEO_CAPTURE) == 0 &&
           (capabilities_ & V4L2_CAP_VIDEO_CAPTURE_MPLANE) != 0;
}

std::uint32_t V4l2Device::buffer_type() const {
    return is_multiplanar() ? V4L2_BUF_TYPE_VIDEO_CAPTURE_MPLANE : V4L2_BUF_TYPE_VIDEO_CAPTURE;
}

bool V4l2Device::try_request(unsigned long code, void* argument) const {
    int result = 0;
    do {
        result = ::ioctl(fd_.get(), code, argument);
    } while (result < 0 && errno == EINTR);
    if (result < 0 && means_gone(errno))
        throw DeviceLost(fmt::format("the camera {} was unplugged", path_.string()));
    return result >= 0;
}

void V4l2Device::request(unsigned long code, void* argument, const char* doing) const {
    if (!try_request(code, argument)) fail_request(doing, errno);
}

void V4l2Device::fail_request(const char* doing, int reason) const {
    if (reason == EBUSY)
        fail("the camera {} is in use by another program, and so it refuses {}", path_.string(),
             doing);
    fail("the camera {} refuses {}: {}", path_.string(), doing, std::strerror(reason));
}

std::vector<V4l2Format> V4l2Device::formats() const {
    std::vector<V4l2Format> result;
    v4l2_fmtdesc entry{};
    entry.type = buffer_type();
    for (; try_request(VIDIOC_ENUM_FMT, &entry); ++entry.index) {
        V4l2Format format;
        format.fourcc = entry.pixelformat;
        format.description = text_of(entry.description);
        format.sizes = sizes(entry.pixelformat, format.any_size_between);
        result.push_back(std::move(format));
    }
    return result;
}

std::vector<V4l2Size> V4l2Device::sizes(std::uint32_t fourcc, bool& any_size_between) const {
    std::vector<V4l2Size> result;
    const auto add = [&](std::uint32_t width, std::uint32_t height) {
        const int w = static_cast<int>(width), h = static_cast<int>(height);
        result.push_back({w, h, rates(fourcc, w, h)});
    };
    v4l2_frmsizeenum entry{};
    entry.pixel_format = fourcc;
    for (; try_request(VIDIOC_ENUM_FRAMESIZES, &entry); ++entry.index) {
        if (entry.type == V4L2_FRMSIZE_TYPE_DISCRETE) {
            add(entry.discrete.width, entry.discrete.height);
            continue;
        }
        any_size_between = true;
        add(entry.stepwise.min_width, entry.stepwise.min_height);
        add(entry.stepwise.max_width, entry.stepwise.max_height);
        break;
    }
    return result;
}

std::vector<double> V4l2Device::rates(std::uint32_t fourcc, int width_px, int height_px) const {
    std::vector<double> result;
    const auto add = [&](const v4l2_fract& period) {
        if (period.numerator > 0)
            result.push_back(static_cast<double>(period.denominator) / period.numerator);
    };
    v4l2_frmivalenum entry{};
    entry.pixel_format = fourcc;
    entry.width = static_cast<std::uint32_t>(width_px);
    entry.height = static_cast<std::uint32_t>(height_px);
    for (; try_request(VIDIOC_ENUM_FRAMEINTERVALS, &entry); ++entry.index) {
        if (entry.type == V4L2_FRMIVAL_TYPE_DISCRETE) {
            add(entry.discrete);
            continue;
        }
        add(entry.stepwise.max);
        add(entry.stepwise.min);
        break;
    }
    return result;
}

std::vector<V4l2Control> V4l2Device::controls() const {
    std::vector<V4l2Control> result;
    v4l2_queryctrl entry{};
    entry.id = V4L2_CTRL_FLAG_NEXT_CTRL;
    for (; try_request(VIDIOC_QUERYCTRL, &entry); entry.id |= V4L2_CTRL_FLAG_NEXT_CTRL) {
        if (!is_numeric(entry.type) || (entry.flags & V4L2_CTRL_FLAG_DISABLED)) continue;
        V4l2Control control{.id = entry.id,
                            .name = text_of(entry.name),
                            .least = entry.minimum,
                            .most = entry.maximum,
                            .usual = entry.default_value,
                            .value = entry.default_value,
                            .is_writable = (entry.flags & V4L2_CTRL_FLAG_READ_ONLY) == 0};
        v4l2_control current{.id = entry.id, .value = 0};
        if (try_request(VIDIOC_G_CTRL, &current)) control.value = current.value;
        result.push_back(std::move(control));
    }
    return result;
}

void V4l2Device::set_control(const V4l2Control& control, std::int32_t value) const {
    v4l2_control wanted{.id = control.id, .value = value};
    if (!try_request(VIDIOC_S_CTRL, &wanted))
        fail("the camera {} refuses {} for its control '{}': {}", path_.string(), value,
             control.name, std::strerror(errno));
}

std::vector<AutomaticControl> automatics_of(const V4l2Device& device) {
    struct Known {
        std::uint32_t id;
        std::int32_t fixed_value;
        const char* what;
    };
    constexpr std::array<Known, 3> known = {{
        {V4L2_CID_EXPOSURE_AUTO, V4L2_EXPOSURE_MANUAL, "exposure"},
        {V4L2_CID_AUTOGAIN, 0, "gain"},
        {V4L2_CID_AUTO_WHITE_BALANCE, 0, "white balance"},
    }};
    std::vector<AutomaticControl> found;
    const std::vector<V4l2Control> controls = device.controls();
    for (const Known& each : known)
        for (const V4l2Control& control : controls)
            if (control.id == each.id)
                found.push_back(
                    {each.what, control.name, each.fixed_value, control.value == each.fixed_value});
    return found;
}

std::vector<std::filesystem::path> list_video_nodes() {
    std::vector<std::filesystem::path> nodes;
    std::error_code ignored;
    for (const auto& entry : std::filesystem::directory_iterator("/dev", ignored))
        if (node_number(entry.path()) >= 0) nodes.push_back(entry.path());
    std::sort(nodes.begin(), nodes.end(),
              [](const auto& a, const auto& b) { return node_number(a) < node_number(b); });
    return nodes;
}

std::filesystem::path stable_video_path(const std::filesystem::path& node) {
    std::error_code ignored;
    for (const auto& entry : std::filesystem::directory_iterator("/dev/v4l/by-path", ignored))
        if (std::filesystem::equivalent(entry.path(), node, ignored)) return entry.path();
    return {};
}

}  // namespace vantage
