#pragma once

#include <memory>

#include "host_app/flight/corridor.h"
#include "host_app/flight/orbit_view.h"

namespace vantage {

/// The virtual camera under operator control. Input moves a goal within the limits; advance() lets
/// the camera follow it smoothly, no faster than the limits allow. Within a corridor the camera
/// slows down on its way out and stops at the end; along the end and back it moves freely.
class OrbitCamera {
  public:
    explicit OrbitCamera(const OrbitView& start, const FlightLimits& limits = {});

    /// Turns around the pivot: to the right and up, as seen by the camera.
    void orbit(double azimuth_rad, double elevation_rad);
    /// Shifts pivot and camera in the image plane, to the right and up, in picture widths at the
    /// pivot's distance. A drag across the whole picture is 1.
    void pan(double right_widths, double up_widths);
    /// Lifts pivot and camera straight up, in the same unit.
    void crane(double up_widths);
    /// Turns the camera where it stands: to the right and up.
    void look(double right_rad, double up_rad);
    /// Turns about the line of sight, clockwise as seen from behind.
    void roll(double clockwise_rad);
    /// Moves the goal to no roll.
    void level();
    /// Shifts pivot and camera until the pivot is at this point.
    void carry_pivot_to(const Eigen::Vector3d& pivot_m);
    /// Divides the distance by e to the power of `nearer`.
    void dolly(double nearer);
    /// Divides the field of view by e to the power of `narrower`.
    void zoom(double narrower);
    /// Flies to a view, the shorter way round. If the view itself is inside the corridor, the way
    /// there may leave it.
    void fly_to(const OrbitView& view);
    /// Limits the camera to this corridor; null: no limit.
    void keep_within(std::shared_ptr<const Corridor> corridor) { corridor_ = std::move(corridor); }
    /// Moves the camera at once.
    void jump_to(const OrbitView& view);

    /// Precondition: dt_s >= 0.
    void advance(double dt_s);

    const OrbitView& view() const { return current_; }
    const OrbitView& goal() const { return goal_; }

  private:
    /// Rates of change of the members of OrbitView, per second.
    struct Speed {
        double azimuth = 0, elevation = 0, roll = 0, distance = 0, field_of_view = 0;
        Eigen::Vector3d pivot{0, 0, 0};
    };
    OrbitView followed(double dt_s) const;
    /// Goes towards `next` as far as the corridor allows.
    void go_within_corridor(const OrbitView& next, double dt_s);

    OrbitView goal_, current_;
    Speed speed_;
    FlightLimits limits_;
    std::shared_ptr<const Corridor> corridor_;
    bool ignores_corridor_ = false;  ///< on a flight to a view inside the corridor
};

}  // namespace vantage
