#pragma once

#include <optional>
#include <span>
#include <string>

#include <Eigen/Core>

#include "common/geometry/pose.h"
#include "host_app/flight/camera_state.h"
#include "host_app/flight/corridor.h"

namespace vantage {

/// Direction of a camera as operators give it: pan to the right about the vertical, tilt up, roll
/// clockwise as seen from behind the camera. Pan 0 looks along -z.
struct PanTiltRoll {
    double pan_rad = 0, tilt_rad = 0, roll_rad = 0;
};
/// For a camera that looks straight up or down pan and roll are the same turn, which is given as
/// pan.
PanTiltRoll pan_tilt_roll_of(const Pose& world_from_camera);
/// The rotation world from camera.
Eigen::Matrix3d turned(const PanTiltRoll& turn);

/// The virtual camera on an orbit: it looks at a pivot from a direction and a distance. The world
/// is right-handed, in metres, with y up and the floor at y = 0.
struct OrbitView {
    Eigen::Vector3d pivot_m{0, 1, 0};
    double azimuth_rad = 0;    ///< around y; 0: the camera is on the +z side; positive towards +x
    double elevation_rad = 0;  ///< of the camera above the pivot's horizon
    double distance_m = 4.5;
    double field_of_view_rad = 0.785;  ///< horizontal
    double roll_rad = 0;  ///< about the line of sight, clockwise as seen from behind the camera

    Eigen::Vector3d eye_m() const;
    Pose world_from_camera() const;
    CameraState camera() const { return {world_from_camera(), field_of_view_rad, distance_m}; }
};

/// The view of a camera at `eye` that looks at `target`. The azimuth is given within half a turn of
/// `near_azimuth_rad`, so that it is continuous along a path. Precondition: eye != target.
OrbitView view_from_eye(const Eigen::Vector3d& eye_m, const Eigen::Vector3d& target_m,
                        double field_of_view_rad, double near_azimuth_rad = 0);

/// The view of any camera, with the pivot at its focus. The azimuth is given as above.
OrbitView orbit_view_of(const CameraState& camera, double near_azimuth_rad = 0);

/// The same angle, moved by whole turns to within half a turn of `near`.
double nearest_turn(double angle_rad, double near_rad);

/// Limits of the virtual camera's place and of its speed under operator control.
struct FlightLimits {
    double min_eye_height_m = 0.05;  ///< keeps the camera above the floor
    double min_distance_m = 0.3, max_distance_m = 60;
    double max_elevation_rad = 1.5;  ///< short of the zenith, where "up" is undefined
    double min_field_of_view_rad = 0.087, max_field_of_view_rad = 2.0;
    double max_pivot_offset_m = 30;  ///< of the pivot from the origin, along each axis

    double max_turn_rad_s = 2.1;
    double max_speed_m_s = 6;
    double max_zoom_rad_s = 1.0;
    double ramp_s = 0.1;     ///< shortest time from rest to the highest speed, and back
    double follow_s = 0.12;  ///< time constant with which the camera follows its goal
};

/// The nearest allowed view: values are clamped, and the elevation is raised until the camera is
/// above the floor.
OrbitView constrained(OrbitView view, const FlightLimits& limits);

/// The view from which an operator takes over a camera: the same picture, with the pivot on the
/// line of sight as near to the focus as the limits allow. Constrained if the limits allow no such
/// view.
OrbitView taken_over(const CameraState& camera, const FlightLimits& limits,
                     double near_azimuth_rad = 0);

/// Whether both views give the same picture; angles may differ by whole turns.
bool is_same_shot(const OrbitView& a, const OrbitView& b);

/// Pose and lens of one rig's camera, and the median of the depth that it measures.
struct FramedRig {
    std::string name;
    Pose world_from_camera = Pose::Identity();
    double field_of_view_rad = 0.785;
    double median_depth_m = 0;  ///< 0: no depth
};

/// Start view, limits and extent of a stage.
struct StageFraming {
    OrbitView start;
    FlightLimits limits;
    StageExtent extent;
};

/// Derives start view, limits and extent of a stage from its rigs. The camera starts at the middle
/// rig, with the pivot where the rigs' optical axes meet; if they do not meet, on its axis at its
/// median depth. Limits and extent are multiples of the largest median depth. The floor is y = 0,
/// or lies below the lowest rig if a rig stands lower. Empty if no rig has depth.
std::optional<StageFraming> frame_stage(std::span<const FramedRig> rigs);

}  // namespace vantage
