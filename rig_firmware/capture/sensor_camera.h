#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/base/time/time.h"
#include "common/image/image.h"
#include "rig_firmware/capture/lent_picture.h"

namespace vantage {

/// One frame of a camera.
struct SensorPicture {
    std::uint32_t sequence = 0;  ///< running count of the driver
    MonotonicTime time{};        ///< the kernel's time stamp
    ColourImage colour;          ///< empty if the image is lent
    std::optional<LentPicture> lent = {};
};

/// Interface of a camera that runs freely or on pulses, on any bus. Methods throw DeviceLost when
/// the camera is gone. Use it from one thread.
class SensorCamera {
  public:
    virtual ~SensorCamera() = default;

    /// Descriptor for poll(), readable while a frame is waiting.
    virtual int fd() const = 0;
    /// Returns the next frame if one is waiting.
    virtual std::optional<SensorPicture> take() = 0;
    /// Sample of the buffers that lent images come in, whole and without a lease. Empty if the
    /// camera cannot lend, because of compressed images or too few buffers.
    virtual std::optional<LentPicture> specimen() const = 0;
    /// Delivers lent images from now on, if there is a specimen.
    virtual void lend() = 0;
    /// Number of frames that were marked as faulty or could not be decoded.
    virtual std::uint64_t damaged() const = 0;
    /// Lines for the start-up report: device, mode, fixed controls, and automatic controls that
    /// should be fixed.
    virtual std::vector<std::string> report() const = 0;
};

/// Opens the camera that [source] names, for images of the configured size, or of twice the width
/// if both sides come in one. Throws Error that lists the alternatives if it is not available.
using CameraOpener =
    std::function<std::unique_ptr<SensorCamera>(const std::string& name, bool side_by_side)>;

}  // namespace vantage
