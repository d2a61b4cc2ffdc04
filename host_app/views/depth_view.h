#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "common/base/shared_bytes.h"
#include "common/colour/colour_correction.h"
#include "common/geometry/pose.h"
#include "common/geometry/rectified_stereo.h"
#include "common/image/image.h"
#include "common/receive/frame_set.h"
#include "common/wire/frame_message.h"
#include "host_app/views/tolerances.h"

namespace vantage {

/// The virtual camera: a pinhole camera with any intrinsics.
struct VirtualView {
    int width_px = 0, height_px = 0;
    Eigen::Matrix3d K = Eigen::Matrix3d::Identity();
    Pose world_from_camera = Pose::Identity();
};

/// Converts a rig's disparities to depth. A value; any thread may use it.
class DisparityScale {
  public:
    DisparityScale() = default;
    /// For a disparity map with `columns` columns, in 1/disparity_steps_per_px of its pixels, of a
    /// pair with this geometry.
    DisparityScale(const RectifiedStereo& geometry, int columns);

    /// z = f * baseline / (d + doffs), metres; 0 if `steps` is 0 (unknown) or d + doffs <= 0.
    float depth_m(std::uint16_t steps) const;
    bool operator==(const DisparityScale&) const = default;

  private:
    float px_per_step_ = 0, doffs_px_ = 0, f_baseline_ = 0;
};

/// One rig (or one entry of a view set) at one instant: a picture with the depth of its pixels and
/// its camera. Copies share the pixels.
struct DepthView {
    std::string name;
    ColourImage colour;
    Eigen::Matrix3d K = Eigen::Matrix3d::Identity();  ///< of the colour picture, px; may have skew
    Pose world_from_camera = Pose::Identity();
    /// z along this camera's axis, metres, 0 = unknown. Has the size of `colour`, or a smaller one
    /// with the same field of view; empty if the view has no depth or `disparity` has it.
    DepthImage depth_m;
    /// The depth as a rig's disparities; sizes as for depth_m.
    DisparityImage disparity = {};
    DisparityScale disparity_scale = {};
    /// The standard deviation of a depth is z^2 * sigma / (f * baseline). 0 if depth does not come
    /// from stereo.
    double baseline_m = 0;
    double doffs_px = 0;
    /// The newest rectified right image, a JPEG in background_match_size() of the colour's size,
    /// whose cx is larger by doffs_px; null if none has arrived.
    SharedBytes right_jpeg = {};
    /// Converts the picture's colours to the stage's; applied by the GPU at the upload.
    ColourCorrection colour_correction = {};

    bool has_depth() const { return !disparity.empty() || !depth_m.empty(); }
    cv::Size depth_size() const { return disparity.empty() ? depth_m.size() : disparity.size(); }
    /// The depth of a pixel of the depth map, metres, 0 = unknown.
    float depth_m_at(int x, int y) const {
        return disparity.empty() ? depth_m(y, x) : disparity_scale.depth_m(disparity(y, x));
    }
    /// Drops the pixels; camera and name stay.
    void release_pictures() {
        colour.release();
        depth_m.release();
        disparity.release();
        right_jpeg.reset();
    }
};

/// The relative standard deviation of a stereo rig's depth for each metre of depth; 0 if the depth
/// does not come from stereo.
inline float depth_spread(const DepthView& camera) {
    const double f_baseline = camera.K(0, 0) * camera.baseline_m;
    return f_baseline > 0 ? static_cast<float>(static_cast<double>(disparity_sigma_px) / f_baseline)
                          : 0.0f;
}

/// Converts a rig's frame to a view, which shares its pixels.
DepthView depth_view_of(const RigFrame& frame);
/// Converts the frames of a frame set that have pictures, with the colour corrections of their
/// rigs.
std::vector<DepthView> depth_views_of(const FrameSet& set,
                                      const std::map<std::string, ColourCorrection>& colours);

/// The checksum of all numbers that place a rig's pixels in the world: "fnv1a64:" and 16 digits.
std::string calibration_of(const DepthView& camera, cv::Size colour_size, cv::Size depth_size);

/// A few surface points of a view, as a summary of the places that it sees.
struct SurfaceSamples {
    std::vector<Eigen::Vector3d> points_m;  ///< in world coordinates
    double median_depth_m = 0;              ///< 0 if the view has no depth
};

/// Samples at most 144 surface points of a view, evenly over its picture.
SurfaceSamples surface_samples(const DepthView& view);

}  // namespace vantage
