#pragma once

#include <memory>
#include <string>

#include "common/config/rig_config.h"
#include "rig_firmware/capture/sensor_camera.h"

namespace libcamera {
class CameraManager;
}

namespace vantage {

/// libcamera as a whole; there is one in a process.
std::shared_ptr<libcamera::CameraManager> start_camera_manager();

/// A camera of libcamera whose requests go round for ever; every picture is converted once, into
/// memory of its own, and its buffer goes back to the driver. Exposure, gain and white balance are
/// fixed as far as the camera lets them. `pattern`: an id, or one with * and ? that fits exactly
/// one camera's id or model. Throws Error that lists the cameras, or the formats and sizes, there
/// are.
std::unique_ptr<SensorCamera> open_libcamera_camera(
    std::shared_ptr<libcamera::CameraManager> manager, const std::string& pattern,
    const RigConfig::Source& request, bool side_by_side);

}  // namespace vantage
