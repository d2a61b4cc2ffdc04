#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "common/receive/frame_set.h"
#include "host_app/desk/desk_state.h"
#include "host_app/flight/camera_state.h"
#include "host_app/flight/corridor.h"
#include "host_app/flight/orbit_view.h"

namespace vantage {

/// Samples a few thousand coloured points of the surfaces that the rigs see, for the 3-D view of
/// the stage.
std::vector<DeskPlan::Point> stage_points(const FrameSet& set);

/// Returns the point (metres, on the stage) of the surface that a camera sees at a place of its
/// picture, 0..1 to the right and down. It is the nearest surface that enough pixels of the rigs
/// support. `aspect` is height divided by width. Nothing if no rig has a depth there.
std::optional<Eigen::Vector3d> surface_at(const FrameSet& set, const CameraState& camera,
                                          double aspect, const Eigen::Vector2d& place);

/// Tracks a performer: returns the position, at the height of `pivot_m`, of the performer who was
/// last at `pivot_m`. It is the mean shift (K. Fukunaga and L. Hostetler, 1975) of the surface
/// points above the floor. Nothing if too few points are near.
std::optional<Eigen::Vector3d> foreground_near(const FrameSet& set, const Eigen::Vector3d& pivot_m);

/// The map of the corridor from above: fields around the camera's pivot, each with the coverage
/// that a camera in its middle would have. A few fields are computed per call, so that the desk
/// never waits for the whole map.
class CorridorFields {
  public:
    /// Computes some more fields, and starts again if corridor, pivot, elevation or field of view
    /// have changed. `reach_m` is the radius of the map.
    void follow(const std::shared_ptr<const Corridor>& corridor, const OrbitView& view,
                double reach_m);

    const std::vector<DeskPlan::Field>& fields() const { return fields_; }
    const Eigen::Vector3d& pivot_m() const { return shown_.pivot_m; }
    double elevation_rad() const { return shown_.elevation_rad; }

  private:
    void begin(const std::shared_ptr<const Corridor>& corridor, const OrbitView& view,
               double reach_m);

    std::shared_ptr<const Corridor> corridor_;
    OrbitView view_, shown_;  ///< of the map that is computed, and of the finished one
    std::size_t next_ = 0;
    std::vector<DeskPlan::Field> fields_, coming_;
};

}  // namespace vantage
