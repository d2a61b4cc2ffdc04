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

/// One picture of a camera.
struct SensorPicture {
    std::uint32_t sequence = 0;  ///< the driver's running count
    MonotonicTime time{};        ///< the kernel's time stamp
    ColourImage colour;          ///< empty where the picture is lent
    std::optional<LentPicture> lent = {};
};

/// A camera that streams by itself or on pulses, whatever interface it has. Throws DeviceLost when
/// it is gone.
class SensorCamera {
  public:
    virtual ~SensorCamera() = default;

    /// Readable while a picture is there, for poll().
    virtual int fd() const = 0;
    /// The next picture if one is there.
    virtual std::optional<SensorPicture> take() = 0;
    /// A buffer such as its pictures would be lent in, whole and without a lease; empty where it
    /// cannot lend: compressed pictures, or too few buffers.
    virtual std::optional<LentPicture> specimen() const = 0;
    /// From now on pictures come lent, where there is a specimen.
    virtual void lend() = 0;
    /// Pictures that came marked as faulty or could not be decoded.
    virtual std::uint64_t damaged() const = 0;
    /// Lines for the start-up report: device and mode; what is fixed, and what is automatic and
    /// should be fixed.
    virtual std::vector<std::string> report() const = 0;
};

/// Opens the camera of a name in [source], for pictures of the configured size, or twice as wide
/// where both sides come in one. Throws Error that says what there is if it cannot be had.
using CameraOpener =
    std::function<std::unique_ptr<SensorCamera>(const std::string& name, bool side_by_side)>;

}  // namespace vantage
