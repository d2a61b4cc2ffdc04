#pragma once

#include <memory>

#include "host_app/flight/corridor.h"
#include "host_app/flight/orbit_view.h"

namespace vantage {

/// The virtual camera in an operator's hands. Inputs move a goal, within the limits; advance() lets
/// the camera follow it smoothly and no faster than the limits allow, so that a jerk of the hand
/// does not reach the picture. Within a corridor it is slowed on its way out and stands at the end;
/// along the end and back it moves freely.
class OrbitCamera {
  public:
    explicit OrbitCamera(const OrbitView& start, const FlightLimits& limits = {});

    /// Around the pivot: to the right and up, as seen by the camera.
    void orbit(double azimuth_rad, double elevation_rad);
    /// Shifts pivot and camera in the picture's plane: to the right and up, in picture widths at
    /// the pivot's distance (what a drag across the whole picture moves).
    void pan(double right_widths, double up_widths);
    /// Lifts pivot and camera straight up, likewise.
    void crane(double up_widths);
    /// Turns the camera where it stands: to the right and up.
    void look(double right_rad, double up_rad);
    /// About the line of sight, clockwise as seen from behind.
    void roll(double clockwise_rad);
    /// From now on towards no roll.
    void level();
    /// Pivot and camera to where the pivot is this point.
    void carry_pivot_to(const Eigen::Vector3d& pivot_m);
    /// Nearer by a factor of e for every 1 (and back for -1).
    void dolly(double nearer);
    /// Narrower by a factor of e for every 1.
    void zoom(double narrower);
    /// Flies to a view, the shorter way round; to one that the corridor holds, whatever lies
    /// between.
    void fly_to(const OrbitView& view);
    /// From now on within this corridor; null: anywhere.
    void keep_within(std::shared_ptr<const Corridor> corridor) { corridor_ = std::move(corridor); }
    /// Is there at once.
    void jump_to(const OrbitView& view);

    /// Lets dt_s seconds pass. Precondition: dt_s >= 0.
    void advance(double dt_s);

    const OrbitView& view() const { return current_; }
    const OrbitView& goal() const { return goal_; }

  private:
    /// How fast it goes, in the view's own numbers.
    struct Speed {
        double azimuth = 0, elevation = 0, roll = 0, distance = 0, field_of_view = 0;
        Eigen::Vector3d pivot{0, 0, 0};
    };
    OrbitView followed(double dt_s) const;
    /// Goes on to `next` as far as the corridor allows.
    void go_within_corridor(const OrbitView& next, double dt_s);

    OrbitView goal_, current_;
    Speed speed_;
    FlightLimits limits_;
    std::shared_ptr<const Corridor> corridor_;
    bool is_let_through_ = false;  ///< on a flight to a view that the corridor holds
};

}  // namespace vantage
