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
    std::vector<double> rates_hz;  ///< empty where the driver does not list them
};

struct V4l2Format {
    std::uint32_t fourcc = 0;
    std::string description;
    std::vector<V4l2Size> sizes;    ///< those listed; for a range its smallest and its largest
    bool any_size_between = false;  ///< sizes is such a range
};

struct V4l2Control {
    std::uint32_t id = 0;
    std::string name;
    std::int32_t least = 0, most = 0, usual = 0, value = 0;
    bool is_writable = false;
};

/// An open video node of the kernel. Every method throws DeviceLost when the device is gone, else
/// Error with the path, the step and the kernel's reason.
class V4l2Device {
  public:
    /// Opens without waiting; the sentence says how to mend a missing node or permission.
    explicit V4l2Device(const std::filesystem::path& path);

    const std::filesystem::path& path() const { return path_; }
    int fd() const { return fd_.get(); }
    const std::string& card() const { return card_; }
    const std::string& bus() const { return bus_; }
    bool captures() const;  ///< delivers pictures in buffers that can be mapped
    /// True if pictures come in the multi-planar form of the interface (of one plane).
    bool is_multiplanar() const;
    std::uint32_t buffer_type() const;

    std::vector<V4l2Format> formats() const;
    /// Integer, boolean and menu controls.
    std::vector<V4l2Control> controls() const;
    void set_control(const V4l2Control& control, std::int32_t value) const;

    /// ioctl that goes on after signals. The first throws; the second says whether it worked and
    /// throws only DeviceLost.
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

/// A control by which a camera changes its picture by itself, which it must not in a take.
struct AutomaticControl {
    std::string what;     ///< "exposure"
    std::string control;  ///< the driver's name
    std::int32_t fixed_value = 0;
    bool is_fixed = false;
};
/// Those of exposure, gain and white balance that the camera has.
std::vector<AutomaticControl> automatics_of(const V4l2Device& device);

/// Paths /dev/video*, by number.
std::vector<std::filesystem::path> list_video_nodes();

/// The link in /dev/v4l/by-path that keeps its name when the numbers change; empty if there is
/// none.
std::filesystem::path stable_video_path(const std::filesystem::path& node);

}  // namespace vantage
