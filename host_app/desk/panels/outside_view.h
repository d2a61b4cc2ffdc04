#pragma once

#include <optional>

#include <Eigen/Core>

#include "host_app/desk/desk_layout.h"
#include "host_app/desk/desk_state.h"
#include "host_app/desk/outside_eye.h"

namespace vantage {

/// From the stage (metres) to the window, as that eye sees it in this part of the window.
class OutsideMap {
  public:
    OutsideMap(const DeskRect& rect, const DeskPlan& plan, const OutsideEye& eye);

    struct Place {
        float x, y;
        double depth_m;
    };
    /// Nothing: it is behind the eye.
    std::optional<Place> at(const Eigen::Vector3d& point_m) const;
    /// What there is of the way between two points before the eye; nothing: none of it.
    struct Line {
        Place from, to;
    };
    std::optional<Line> line(const Eigen::Vector3d& from_m, const Eigen::Vector3d& to_m) const;
    double px_per_m(double depth_m) const { return focal_px_ / depth_m; }

  private:
    Place place_of(const Eigen::Vector3d& in_camera) const;

    Pose camera_from_world_;
    double focal_px_;
    float middle_x_, middle_y_;
};

}  // namespace vantage
