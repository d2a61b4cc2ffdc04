#pragma once

#include <memory>

#include "common/config/rig_config.h"
#include "rig_firmware/capture/sensor_camera.h"
#include "rig_firmware/capture/stereo_source.h"

namespace vantage {

/// Creates a source of two cameras on one interface ('left_device' and 'right_device' of [source]),
/// or of one camera that delivers both sides in one image. Throws Error if the cameras are not
/// available.
std::unique_ptr<StereoSource> make_camera_source(const RigConfig& config, CameraOpener open);

}  // namespace vantage
