#pragma once

#include <chrono>
#include <cstdint>

#include "common/geometry/stereo_calibration.h"
#include "common/image/image.h"
#include "common/virtual_stage/virtual_stage.h"

namespace vantage {

/// Where a stereo rig stands around the virtual stage; it looks at the pivot (0, 1, 0).
struct VirtualRigPlacement {
    double azimuth_rad = 0;  ///< around y, 0 = on +z, positive towards +x
    double elevation_rad = 0.17;
    double distance_m = 4.5;  ///< of the middle between the two cameras from the pivot
    double baseline_m = 0.12;
    double field_of_view_rad = 0.87;  ///< horizontal
    int width_px = 320, height_px = 240;
};

/// The calibration of an ideal (already rectified) rig standing there, world_from_left included.
StereoCalibration ideal_virtual_rig(const VirtualRigPlacement& placement);

/// Additive sensor noise: Gaussian, sigma in 8-bit grey levels, other values for every seed, side
/// and frame, the same for the same ones.
struct SensorNoise {
    double sigma = 0;
    std::uint64_t seed = 1;
};

struct VirtualStereoFrame {
    ColourImage left,
        right;  ///< as the sensors see it: distorted and unrectified if the calibration is so
    DisparityImage exact_disparity;  ///< of the rectified left picture, from exact depth
};

/// What the two sensors of a rig see at a time. For calibrations with distortion or rotation the
/// ideal view is rendered wide enough and resampled through the lens model.
VirtualStereoFrame render_virtual_rig(VirtualStage& stage, const StereoCalibration& calibration,
                                      std::chrono::nanoseconds stage_time,
                                      std::uint64_t frame_index, const SensorNoise& noise);

}  // namespace vantage
