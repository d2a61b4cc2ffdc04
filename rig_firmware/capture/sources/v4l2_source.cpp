#include "common/base/time/pulse_grid.h"
#include "common/config/rig_config.h"
#include "rig_firmware/capture/camera_source.h"
#include "rig_firmware/capture/v4l2/v4l2_camera.h"

namespace vantage {

SourceEntry v4l2_source_entry() {
    return {.kind = "v4l2", .takes_ideal_rig = false, .make = [](const RigConfig& config) {
                return make_camera_source(
                    config, [source = config.source](const std::string& device, bool side_by_side) {
                        return std::make_unique<V4l2Camera>(
                            V4l2Settings{.path = device,
                                         .width_px = source.width_px * (side_by_side ? 2 : 1),
                                         .height_px = source.height_px,
                                         .rate_hz = PulseGrid(source.rate_hz).rate_hz(),
                                         .pixel_format = source.pixel_format,
                                         .controls = source.controls,
                                         .share_buffers = source.buffers != "copy"});
                    });
            }};
}

}  // namespace vantage
