#pragma once

#include <memory>

#include "common/config/rig_config.h"
#include "rig_firmware/capture/sensor_camera.h"
#include "rig_firmware/capture/stereo_source.h"

namespace vantage {

/// A source of two cameras of one interface ('left_device' and 'right_device' of [source]), or of
/// one that delivers both sides in one picture. Throws Error if they cannot be had.
std::unique_ptr<StereoSource> make_camera_source(const RigConfig& config, CameraOpener open);

}  // namespace vantage
