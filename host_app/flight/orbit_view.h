#pragma once

#include <Eigen/Core>

#include "common/geometry/pose.h"
#include "host_app/flight/camera_state.h"

namespace vantage {

/// Where the virtual camera is, as an operator thinks of it: it looks at a pivot from a direction
/// and a distance. World: right-handed, metres, y up, floor at y = 0.
struct OrbitView {
    Eigen::Vector3d pivot_m{0, 1, 0};
    double azimuth_rad = 0;    ///< around y, 0 = the camera on the +z side, positive towards +x
    double elevation_rad = 0;  ///< of the camera above the pivot's horizon
    double distance_m = 4.5;
    double field_of_view_rad = 0.785;  ///< horizontal
    double roll_rad = 0;  ///< about the line of sight, clockwise as seen from behind the camera

    Eigen::Vector3d eye_m() const;
    Pose world_from_camera() const;
    CameraState camera() const { return {world_from_camera(), field_of_view_rad, distance_m}; }
};

/// The view of a camera at `eye` that looks at `target`. The azimuth is the one nearest to
/// `near_azimuth_rad`, so that a series of views does not jump by a turn. Precondition: eye !=
/// target.
OrbitView view_from_eye(const Eigen::Vector3d& eye_m, const Eigen::Vector3d& target_m,
                        double field_of_view_rad, double near_azimuth_rad = 0);

/// The view of a camera whose pivot is its focus; any camera is one. The azimuth as above.
OrbitView orbit_view_of(const CameraState& camera, double near_azimuth_rad = 0);

/// The same angle as `angle`, moved by whole turns to within half a turn of `near`.
double nearest_turn(double angle_rad, double near_rad);

/// Where the virtual camera may go, and how fast an operator may move it.
struct FlightLimits {
    double min_eye_height_m = 0.05;  ///< never through the floor
    double min_distance_m = 0.3, max_distance_m = 60;
    double max_elevation_rad = 1.5;  ///< short of the zenith, where "up" has no meaning
    double min_field_of_view_rad = 0.087, max_field_of_view_rad = 2.0;
    double max_pivot_offset_m = 30;  ///< of the pivot from the origin, along each axis

    double max_turn_rad_s = 2.1;
    double max_speed_m_s = 6;
    double max_zoom_rad_s = 1.0;
    double ramp_s = 0.1;     ///< from rest to the highest speed, or back, at the earliest
    double follow_s = 0.12;  ///< in which the camera covers 63 % of the way to where hands want it
};

/// The nearest allowed view: values are clamped, and the elevation is raised until the camera is
/// above the floor.
OrbitView constrained(OrbitView view, const FlightLimits& limits);

/// A view for hands that take over from this camera: the same picture, with its pivot on the line
/// of sight as near to the focus as the limits allow; constrained where no such view is allowed.
OrbitView taken_over(const CameraState& camera, const FlightLimits& limits,
                     double near_azimuth_rad = 0);

/// The same picture, whole turns aside.
bool is_same_shot(const OrbitView& a, const OrbitView& b);

}  // namespace vantage
