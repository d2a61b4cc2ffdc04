#pragma once

#include <optional>

#include "common/receive/frame_set.h"
#include "host_app/flight/camera_state.h"

namespace vantage {

/// The surface that a camera sees at a place of its picture (0..1 to the right and down), from the
/// depth of the set's rigs: the nearest there that a number of their pixels agree on. `aspect`:
/// height by width. Nothing: no rig has a depth there.
std::optional<Eigen::Vector3d> surface_at(const FrameSet& set, const CameraState& camera,
                                          double aspect, const Eigen::Vector2d& place);

/// Where a performer who stood at `pivot_m` is in this set, at the same height: the middle of what
/// the rigs see of surfaces there above the floor, found by going to it some times (mean shift, K.
/// Fukunaga and L. Hostetler, 1975). Nothing: too little is there.
std::optional<Eigen::Vector3d> foreground_near(const FrameSet& set, const Eigen::Vector3d& pivot_m);

}  // namespace vantage
