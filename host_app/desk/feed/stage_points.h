#pragma once

#include <optional>
#include <vector>

#include "common/receive/frame_set.h"
#include "host_app/desk/desk_state.h"
#include "host_app/flight/camera_state.h"

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

}  // namespace vantage
