#pragma once

#include <chrono>
#include <cstdint>

#include "common/geometry/stereo_calibration.h"
#include "common/image/image.h"
#include "common/virtual_stage/virtual_stage.h"

namespace vantage {

/// The placement of a stereo rig around the virtual stage; it looks at the pivot (0, 1, 0).
struct VirtualRigPlacement {
    double azimuth_rad = 0;  ///< around y; 0 is on +z, positive towards +x
    double elevation_rad = 0.17;
    double distance_m = 4.5;  ///< from the pivot to the middle between the two cameras
    double baseline_m = 0.12;
    double field_of_view_rad = 0.87;  ///< horizontal
    int width_px = 320, height_px = 240;
};

/// The calibration, including world_from_left, of an ideal (already rectified) rig at a placement.
/// Throws Error for an invalid placement.
StereoCalibration ideal_virtual_rig(const VirtualRigPlacement& placement);

/// Additive Gaussian sensor noise, sigma in 8-bit grey levels, independent for every pixel and
/// colour. The same seed, side and frame give the same noise.
struct SensorNoise {
    double sigma = 0;
    std::uint64_t seed = 1;
};

struct VirtualStereoFrame {
    ColourImage left,
        right;  ///< the sensor images: distorted and unrectified if the calibration is
    DisparityImage exact_disparity;  ///< of the rectified left image, from the true depth
};

/// A stereo rig that films the virtual stage. An ideal rig renders directly; for lenses with
/// distortion, a wider pinhole image of twice the resolution is rendered and resampled through the
/// lens model, whose map is computed once at construction.
class VirtualRig {
  public:
    /// Throws Error for an invalid calibration, and for lenses that see further than about 75
    /// degrees off their axis, which no pinhole image covers. Without exact disparity, frames leave
    /// it empty and need one rendering less.
    VirtualRig(const StereoCalibration& calibration, const SensorNoise& noise,
               bool with_exact_disparity = true);

    /// Renders the images of both sensors at a time.
    VirtualStereoFrame render(VirtualStage& stage, std::chrono::nanoseconds stage_time,
                              std::uint64_t frame_index) const;

    /// Renders without noise, so that the result can be reused a stage loop later; add_noise() adds
    /// it. The right sensor may be skewed in time.
    VirtualStereoFrame render_noiseless(VirtualStage& stage, std::chrono::nanoseconds stage_time,
                                        std::chrono::nanoseconds right_later = {}) const;
    void add_noise(VirtualStereoFrame& frame, std::uint64_t frame_index) const;

  private:
    struct Sensor {
        StageCamera camera;   ///< the pinhole camera to render
        cv::Mat2f positions;  ///< in its image, for 2 x 2 points of every pixel; empty: none
        cv::Size size;        ///< of the sensor's image
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

/// Renders one frame with a temporary VirtualRig.
VirtualStereoFrame render_virtual_rig(VirtualStage& stage, const StereoCalibration& calibration,
                                      std::chrono::nanoseconds stage_time,
                                      std::uint64_t frame_index, const SensorNoise& noise);

/// Adds noise to an image; `side` 0 is left, 1 right.
void add_sensor_noise(ColourImage& picture, const SensorNoise& noise, int side,
                      std::uint64_t frame_index);

/// Disparity from depth, rounded to its steps; 0 where depth is unknown or not positive.
DisparityImage disparity_from_depth(const DepthImage& depth_m, const RectifiedStereo& geometry);

}  // namespace vantage
