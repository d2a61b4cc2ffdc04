#include "host_app/camera_paths/camera_path_file.h"

#include <numbers>

#include "common/base/error.h"

namespace vantage {

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
