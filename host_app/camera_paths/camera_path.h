#pragma once

#include <optional>
#include <vector>

#include <opencv2/core/types.hpp>

#include "host_app/flight/camera_state.h"
#include "host_app/flight/moves/flight_recording.h"

namespace vantage {

/// A camera's way as other programs have it: a camera a picture, evenly in time.
struct CameraPath {
    double rate_hz = 25;
    cv::Size size_px{1920, 1080};  ///< of the pictures; its shape is the lens's
    std::vector<CameraState> cameras;
};

/// Settings that a camera file may lack.
struct CameraPathSettings {
    /// Rate of its cameras, or at which an animation is sampled; empty: the file's, else 25 Hz.
    std::optional<double> rate_hz = {};
    cv::Size size_px{1920, 1080};                  ///< where the file says none
    double focus_m = 4.5;                          ///< where the file says none
    std::optional<double> field_of_view_rad = {};  ///< instead of what the file says
};

constexpr double default_camera_rate_hz = 25;

/// Most cameras that a file may have: ten minutes at 60 a second, and some.
constexpr std::size_t most_cameras = 40'000;

/// From the move's start to its end. Throws Error where that are more than most_cameras.
CameraPath sampled(const Move& move, double rate_hz, cv::Size size_px);

/// A move on a free path, as near to the cameras as the tolerance says (see simplified()).
/// Precondition: there is a camera.
SimplifiedFlight move_along(const CameraPath& path, const FlightTolerance& tolerance);

}  // namespace vantage
