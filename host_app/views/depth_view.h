#pragma once

#include <cstdint>
#include <string>

#include "common/base/shared_bytes.h"
#include "common/colour/colour_correction.h"
#include "common/geometry/pose.h"
#include "common/geometry/rectified_stereo.h"
#include "common/image/image.h"

namespace vantage {

/// How far away a rig's disparities are.
class DisparityScale {
  public:
    DisparityScale() = default;
    /// Disparities of a map with `columns`, in steps of that map's pixels, of a pair with this
    /// geometry.
    DisparityScale(const RectifiedStereo& geometry, int columns);

    /// z = f * baseline / (d + doffs); 0 where `steps` is 0 (unknown), or where d + doffs <= 0.
    float depth_m(std::uint16_t steps) const;
    bool operator==(const DisparityScale&) const = default;

  private:
    float px_per_step_ = 0, doffs_px_ = 0, f_baseline_ = 0;
};

/// What one rig (or one entry of a view set) knows of an instant: a picture with the depth of its
/// pixels.
struct DepthView {
    std::string name;
    ColourImage colour;
    Eigen::Matrix3d K = Eigen::Matrix3d::Identity();  ///< of the colour picture, px; may have skew
    Pose world_from_camera = Pose::Identity();
    /// z along this camera's axis, metres, 0 = unknown; of the colour's size, or a smaller one with
    /// the same field of view; empty: the view gives no geometry.
    DepthImage depth_m;
    /// Instead of depth_m, a rig's disparities as they came; sizes as there.
    DisparityImage disparity = {};
    DisparityScale disparity_scale = {};
    /// Depth uncertainty of a pixel is z^2 * sigma / (f * baseline): baseline 0 where depth does
    /// not come of stereo.
    double baseline_m = 0;
    double doffs_px = 0;
    /// The rectified right picture, of set_match_size() of the colour's; its cx is doffs_px
    /// more. A JPEG, the newest that came; null: none has.
    SharedBytes right_jpeg = {};
    /// Brings the picture's colours to the stage's; done on the GPU on its way to the synthesisers.
    ColourCorrection colour_correction = {};

    bool has_depth() const { return !disparity.empty() || !depth_m.empty(); }
    cv::Size depth_size() const { return disparity.empty() ? depth_m.size() : disparity.size(); }
    /// Of a pixel of the depth map.
    float depth_m_at(int x, int y) const {
        return disparity.empty() ? depth_m(y, x) : disparity_scale.depth_m(disparity(y, x));
    }
    /// Camera, name and sizes stay.
    void release_pictures() {
        colour.release();
        depth_m.release();
        disparity.release();
        right_jpeg.reset();
    }
};

}  // namespace vantage
