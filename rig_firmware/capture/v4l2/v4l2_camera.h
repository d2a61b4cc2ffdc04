#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/base/files/unique_fd.h"
#include "common/base/time/time.h"
#include "common/image/image.h"
#include "rig_firmware/capture/buffer_lender.h"
#include "rig_firmware/capture/pixel_conversion.h"
#include "rig_firmware/capture/sensor_camera.h"
#include "rig_firmware/capture/v4l2/v4l2_device.h"

namespace vantage {

struct V4l2Settings {
    std::filesystem::path path;
    int width_px = 0, height_px = 0;  ///< size of the device's images
    double rate_hz = 0;
    std::string pixel_format;  ///< four characters; empty: the first known format with this size
    std::map<std::string, int> controls;  ///< by the driver's names, case-insensitive
    bool share_buffers = true;            ///< as dma-bufs, if the driver can
};

/// V4L2 camera that streams into mapped buffers, which the driver shares as dma-bufs if it can
/// (VIDIOC_EXPBUF). Images are either lent, or converted with their buffers returned at once.
/// Throws like V4l2Device.
class V4l2Camera final : public SensorCamera {
  public:
    /// Opens the device, sets mode and controls, and starts streaming. Throws Error that lists the
    /// driver's modes if it does not support the settings.
    explicit V4l2Camera(const V4l2Settings& request);
    ~V4l2Camera() override;
    V4l2Camera(const V4l2Camera&) = delete;
    V4l2Camera& operator=(const V4l2Camera&) = delete;

    int fd() const override { return device_.fd(); }
    cv::Size size() const { return {mode_.width_px, mode_.height_px}; }

    std::optional<SensorPicture> take() override;
    std::optional<LentPicture> specimen() const override;
    void lend() override;
    std::uint64_t damaged() const override { return damaged_; }
    std::vector<std::string> report() const override;

  private:
    struct Mode {
        PixelFormat format = PixelFormat::grey;
        int width_px = 0, height_px = 0;
        std::size_t bytes_per_line = 0;
        double rate_hz = 0;  ///< 0: the driver reports no rate
    };

    /// Buffer of the driver, mapped into this process.
    class Mapping {
      public:
        Mapping(int fd, std::size_t length, std::int64_t offset);
        ~Mapping();
        Mapping(const Mapping&) = delete;
        Mapping& operator=(const Mapping&) = delete;
        bool is_mapped() const { return start_ != nullptr; }
        std::span<const std::byte> bytes() const { return {start_, length_}; }

        UniqueFd dma_buf;  ///< none: the driver does not share it

      private:
        std::byte* start_ = nullptr;
        std::size_t length_ = 0;
    };

    void choose_format(const V4l2Settings& request);
    bool set_format(PixelFormat format, const V4l2Settings& request, bool only_try,
                    cv::Size& offered);
    void set_rate(double rate_hz);
    void set_controls(const std::map<std::string, int>& requests);
    void map_buffers(bool share_them);
    UniqueFd share(std::uint32_t index) const;
    void queue(std::uint32_t index);
    void take_back(std::uint32_t index) noexcept;
    LentPicture lent(std::uint32_t index, std::span<const std::byte> bytes) const;

    V4l2Device device_;
    Mode mode_;
    std::vector<std::shared_ptr<const Mapping>> buffers_;
    std::uint64_t damaged_ = 0;
    bool lends_ = false;
    BufferLender lender_;  ///< the last member, since returned buffers use the members above
};

}  // namespace vantage
