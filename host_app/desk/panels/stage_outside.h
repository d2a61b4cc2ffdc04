#pragma once

#include <optional>

#include <Eigen/Core>

#include "host_app/desk/desk_arrangement.h"
#include "host_app/desk/desk_state.h"

namespace vantage {

/// The perspective projection of the desk's 3-D view: from the stage (metres) to the window
/// (pixels).
class OutsideMap {
  public:
    OutsideMap(const DeskRect& rect, const DeskPlan& plan, const OutsideEye& eye);

    struct Place {
        float x, y;
        double depth_m;
    };
    /// Projects a point; nothing if it lies behind the eye.
    std::optional<Place> at(const Eigen::Vector3d& point_m) const;
    struct Line {
        Place from, to;
    };
    /// Projects the part of a line that lies before the eye; nothing if there is none.
    std::optional<Line> line(const Eigen::Vector3d& from_m, const Eigen::Vector3d& to_m) const;
    double px_per_m(double depth_m) const { return focal_px_ / depth_m; }

  private:
    Place place_of(const Eigen::Vector3d& in_camera) const;

    Pose camera_from_world_;
    double focal_px_;
    float middle_x_, middle_y_;
};

}  // namespace vantage
