#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "common/base/files/unique_fd.h"
#include "rig_firmware/capture/device_lost.h"

namespace vantage {

struct V4l2Size {
    int width_px = 0, height_px = 0;
    std::vector<double> rates_hz;  ///< empty if the driver does not list them
};

struct V4l2Format {
    std::uint32_t fourcc = 0;
    std::string description;
    std::vector<V4l2Size> sizes;    ///< listed sizes; for a range its smallest and its largest
    bool any_size_between = false;  ///< `sizes` is a range
};

struct V4l2Control {
    std::uint32_t id = 0;
    std::string name;
    std::int32_t least = 0, most = 0, usual = 0, value = 0;
    bool is_writable = false;
};

/// Open V4L2 node of the kernel. Every method throws DeviceLost when the device is gone, else Error
/// with the path, the step and the kernel's reason.
class V4l2Device {
  public:
    /// Opens the node without blocking. The error sentence says how to mend a missing node or
    /// permission.
    explicit V4l2Device(const std::filesystem::path& path);

    const std::filesystem::path& path() const { return path_; }
    int fd() const { return fd_.get(); }
    const std::string& card() const { return card_; }
    const std::string& bus() const { return bus_; }
    bool captures() const;  ///< captures frames into buffers that can be mapped
    /// True if the device uses the multi-planar API (with one plane).
    bool is_multiplanar() const;
    std::uint32_t buffer_type() const;

    std::vector<V4l2Format> formats() const;
    /// Integer, boolean and menu controls.
    std::vector<V4l2Control> controls() const;
    void set_control(const V4l2Control& control, std::int32_t value) const;

    /// Calls ioctl and repeats it after signals. request() throws on failure; the second method
    /// returns whether it worked and throws DeviceLost only.
    void request(unsigned long code, void* argument, const char* doing) const;
    bool try_request(unsigned long code, void* argument) const;

  private:
    [[noreturn]] void fail_request(const char* doing, int reason) const;
    std::vector<V4l2Size> sizes(std::uint32_t fourcc, bool& any_size_between) const;
    std::vector<double> rates(std::uint32_t fourcc, int width_px, int height_px) const;

    std::filesystem::path path_;
    UniqueFd fd_;
    std::string card_, bus_;
    std::uint32_t capabilities_ = 0;
};

/// Control by which a camera adjusts its images automatically, which it must not do during a show.
struct AutomaticControl {
    std::string what;     ///< "exposure"
    std::string control;  ///< the driver's name
    std::int32_t fixed_value = 0;
    bool is_fixed = false;
};
/// Automatic controls of exposure, gain and white balance that the camera has.
std::vector<AutomaticControl> automatics_of(const V4l2Device& device);

/// Paths /dev/video*, by number.
std::vector<std::filesystem::path> list_video_nodes();

/// Link in /dev/v4l/by-path that keeps its name when the numbers change; empty if there is none.
std::filesystem::path stable_video_path(const std::filesystem::path& node);

}  // namespace vantage
