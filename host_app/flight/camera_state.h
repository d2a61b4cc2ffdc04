#pragma once

#include <deque>

#include <Eigen/Core>

#include "common/geometry/pose.h"

namespace vantage {

/// The virtual camera at one moment: pose and lens. All camera sources (orbit, keyframes, tracked
/// camera) produce one.
struct CameraState {
    Pose world_from_camera = Pose::Identity();
    double field_of_view_rad = 0.785;  ///< horizontal
    double focus_m = 4.5;              ///< distance of the pivot or of the focal plane

    /// Intrinsics of a pinhole camera with square pixels and a centred principal point.
    Eigen::Matrix3d K(int width_px, int height_px) const;
};

/// Whether frames of the two cameras look the same: they differ by less than 0.1 pixel.
bool is_same_view(const CameraState& a, const CameraState& b);

/// Interpolates on the straight way between two cameras; 0 gives `a`, 1 gives `b`.
CameraState mixed(const CameraState& a, const CameraState& b, double share_of_b);

/// Predicts a camera at constant velocity and constant turn rate, measured over the last 0.12 s. A
/// cut starts the measurement again.
class CameraForecast {
  public:
    /// Times must not decrease.
    void see(const CameraState& camera, double time_s);

    /// The camera `ahead_s` after the last one that was seen, with its lens; limited to 1 s, since
    /// no operator holds a course for longer. Precondition: see() was called.
    CameraState in(double ahead_s) const;

  private:
    struct Sample {
        CameraState camera;
        double time_s;
    };
    std::deque<Sample> samples_;
};

}  // namespace vantage
