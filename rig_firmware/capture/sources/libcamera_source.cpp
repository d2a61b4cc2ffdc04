#include "common/config/rig_config.h"
#include "rig_firmware/capture/camera_source.h"
#include "rig_firmware/capture/libcamera/libcamera_camera.h"

namespace vantage {

SourceEntry libcamera_source_entry() {
    return {.kind = "libcamera", .takes_ideal_rig = false, .make = [](const RigConfig& config) {
                return make_camera_source(
                    config, [source = config.source, manager = start_camera_manager()](
                                const std::string& name, bool side_by_side) {
                        return open_libcamera_camera(manager, name, source, side_by_side);
                    });
            }};
}

}  // namespace vantage
