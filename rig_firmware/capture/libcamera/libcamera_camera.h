#pragma once

#include <memory>
#include <string>

#include "common/config/rig_config.h"
#include "rig_firmware/capture/sensor_camera.h"

namespace libcamera {
class CameraManager;
}

namespace vantage {

/// Starts libcamera's camera manager; a process may have only one.
std::shared_ptr<libcamera::CameraManager> start_camera_manager();

/// Opens a libcamera camera with a ring of requests. Every image is converted once into its own
/// memory, and its buffer goes back to the driver. Exposure, gain and white balance are fixed as
/// far as the camera allows. `pattern` is an id, or a pattern with * and ? that matches exactly one
/// camera's id or model. Throws Error that lists the cameras, or the formats and sizes.
std::unique_ptr<SensorCamera> open_libcamera_camera(
    std::shared_ptr<libcamera::CameraManager> manager, const std::string& pattern,
    const RigConfig::Source& request, bool side_by_side);

}  // namespace vantage
