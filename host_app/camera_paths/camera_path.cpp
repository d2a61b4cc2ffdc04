#include "host_app/camera_paths/camera_path.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

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

std::vector<CameraPathForm> camera_path_forms() {
    return {freed_form(), colmap_form(), omaf_form(), gltf_form()};
}

CameraPathForm form_of(const std::filesystem::path& file) {
    std::string names;
    for (const CameraPathForm& form : camera_path_forms()) {
        if (form.is_named_so(file)) return form;
        names += "; " + form.words;
    }
    fail("{}: the name says of no camera path that Vantage knows: NAME.toml, a flight file{}",
         file.string(), names);
}

void require_cameras(std::size_t count, const std::filesystem::path& file) {
    if (count == 0) fail("{} has no camera", file.string());
    if (count > most_cameras)
        fail("{} has {} cameras, and {} are the most", file.string(), count, most_cameras);
}

double checked_field_of_view(double angle_rad, const std::filesystem::path& file) {
    constexpr double deg = 180 / std::numbers::pi;
    const FlightLimits limits;
    if (!(angle_rad >= limits.min_field_of_view_rad && angle_rad <= limits.max_field_of_view_rad))
        fail(
            "{} has a camera with a horizontal field of view of {:.1f} degrees, and {:.0f} to "
            "{:.0f} are flown; say another with --fov",
            file.string(), angle_rad * deg, limits.min_field_of_view_rad * deg,
            limits.max_field_of_view_rad * deg);
    return angle_rad;
}

}  // namespace vantage
