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
/// Throws Error for a placement that cannot be.
StereoCalibration ideal_virtual_rig(const VirtualRigPlacement& placement);

/// Additive sensor noise: Gaussian, sigma in 8-bit grey levels, independent for every pixel and
/// colour; other values for every seed, side and frame, the same for the same ones.
struct SensorNoise {
    double sigma = 0;
    std::uint64_t seed = 1;
};

struct VirtualStereoFrame {
    ColourImage left,
        right;  ///< as the sensors see it: distorted and unrectified if the calibration is so
    DisparityImage exact_disparity;  ///< of the rectified left picture, from exact depth
};

/// A stereo rig that films the virtual stage: an ideal one directly; for lenses with distortion a
/// pinhole picture is rendered wide enough and twice as fine, and resampled through the lens model.
/// What a lens needs is worked out once, here.
class VirtualRig {
  public:
    /// Throws Error for an impossible calibration, and for lenses that see further than about 75
    /// degrees off their axis, which no pinhole picture holds. Without exact disparity its frames
    /// leave that empty, and cost a rendering less.
    VirtualRig(const StereoCalibration& calibration, const SensorNoise& noise,
               bool with_exact_disparity = true);

    /// What the two sensors see at a time.
    VirtualStereoFrame render(VirtualStage& stage, std::chrono::nanoseconds stage_time,
                              std::uint64_t frame_index) const;

    /// The same in two steps: what is the same a whole loop of the stage later, and the noise.
    /// The right sensor may see the stage later than the left one.
    VirtualStereoFrame render_noiseless(VirtualStage& stage, std::chrono::nanoseconds stage_time,
                                        std::chrono::nanoseconds right_later = {}) const;
    void add_noise(VirtualStereoFrame& frame, std::uint64_t frame_index) const;

  private:
    struct Sensor {
        StageCamera camera;   ///< the pinhole camera to render
        cv::Mat2f positions;  ///< in its picture, for 2 x 2 points of every pixel; empty: none
        cv::Size size;        ///< of the sensor's picture
    };
    static Sensor make_sensor(const CameraModel& model, const Pose& world_from_camera);
    static ColourImage see(const Sensor& sensor, VirtualStage& stage,
                           std::chrono::nanoseconds stage_time);

    Sensor left_, right_;
    StageCamera rectified_left_;
    RectifiedStereo rectified_;
    SensorNoise noise_;
    bool with_exact_disparity_;
};

/// One frame of a VirtualRig made for it.
VirtualStereoFrame render_virtual_rig(VirtualStage& stage, const StereoCalibration& calibration,
                                      std::chrono::nanoseconds stage_time,
                                      std::uint64_t frame_index, const SensorNoise& noise);

/// The noise by itself; `side` 0 is left, 1 right.
void add_sensor_noise(ColourImage& picture, const SensorNoise& noise, int side,
                      std::uint64_t frame_index);

/// Disparity on the wire from depth: rounded to its steps, 0 where it is unknown or not positive.
DisparityImage disparity_from_depth(const DepthImage& depth_m, const RectifiedStereo& geometry);

}  // namespace vantage
