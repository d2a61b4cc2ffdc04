#include "host_app/camera_paths/camera_path.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "common/base/error.h"

namespace vantage {

CameraPath sampled(const Move& move, double rate_hz, cv::Size size_px) {
    constexpr double rounding = 1e-9;
    const double last = std::floor(move.duration_s() * rate_hz + rounding);
    if (last + 1 > static_cast<double>(most_cameras))
        fail(
            "a move of {:.1f} s has {:.0f} cameras at {:g} a second, and {} are the most; give a "
            "lower --rate",
            move.duration_s(), last + 1, rate_hz, most_cameras);
    CameraPath path{rate_hz, size_px, {}};
    for (int i = 0; i <= static_cast<int>(last); ++i)
        path.cameras.push_back(move.at(i / rate_hz).camera());
    return path;
}

SimplifiedFlight move_along(const CameraPath& path, const FlightTolerance& tolerance) {
    assert(!path.cameras.empty());
    FlightRecording flight;
    FlightLimits limits;
    for (std::size_t i = 0; i < path.cameras.size(); ++i) {
        const CameraState& camera = path.cameras[i];
        limits.min_eye_height_m =
            std::min(limits.min_eye_height_m, camera.world_from_camera.translation().y());
        flight.push_back(
            {static_cast<double>(i) / path.rate_hz,
             orbit_view_of(camera, flight.empty() ? 0 : flight.back().view.azimuth_rad),
             {}});
    }
    return simplified(flight, tolerance, limits, MovePath::free);
}

}  // namespace vantage
