#include "rig_firmware/capture/rig_calibration.h"

#include <numbers>

#include "common/base/error.h"
#include "common/config/calibration_file.h"
#include "common/virtual_stage/virtual_rig.h"
#include "rig_firmware/capture/stereo_source.h"

namespace vantage {
namespace {

double radians(double degrees) { return degrees * std::numbers::pi / 180; }

void require_size(const char* side, const CameraModel& camera, cv::Size picture_size,
                  const RigConfig& config) {
    if (camera.width_px == picture_size.width && camera.height_px == picture_size.height) return;
    fail(
        "{} is for {} pictures of {}x{}, and the source '{}' delivers {}x{}: set the source to the "
        "calibrated size, or calibrate at this one",
        config.calibration.string(), side, camera.width_px, camera.height_px, config.source.kind,
        picture_size.width, picture_size.height);
}

}  // namespace

StereoCalibration ideal_rig(const RigConfig& config, cv::Size picture_size) {
    const RigConfig::VirtualRig& rig = config.virtual_rig;
    StereoCalibration calibration =
        ideal_virtual_rig({.azimuth_rad = radians(rig.azimuth_deg),
                           .elevation_rad = radians(rig.elevation_deg),
                           .distance_m = rig.distance_m,
                           .baseline_m = rig.baseline_m,
                           .field_of_view_rad = radians(rig.field_of_view_deg),
                           .width_px = picture_size.width,
                           .height_px = picture_size.height});
    calibration.right.cx_px += rig.doffs_px;
    calibration.rectified.cx_right_px += rig.doffs_px;
    calibration.id = calibration_checksum(calibration);
    return calibration;
}

StereoCalibration rig_calibration(const RigConfig& config, cv::Size picture_size) {
    if (config.calibration.empty()) {
        if (find_source(config).takes_ideal_rig) return ideal_rig(config, picture_size);
        fail(
            "the source '{}' needs a calibration: name it with 'calibration' in the rig's "
            "configuration; until there is one set calibration = \"none\" and make it with "
            "vantage-calib stereo --live",
            config.source.kind);
    }
    StereoCalibration calibration = load_calibration(config.calibration);
    require_size("left", calibration.left, picture_size, config);
    require_size("right", calibration.right, picture_size, config);
    return calibration;
}

}  // namespace vantage
