#include <fmt/format.h>

#include "common/base/error.h"
#include "common/base/files/atomic_file.h"
#include "host_app/camera_paths/camera_path.h"
#include "host_app/control/tracking/freed_message.h"

namespace vantage {
namespace {

constexpr double mm = 1000;

}  // namespace

CameraPath freed_path_of(std::span<const std::byte> bytes, const std::filesystem::path& file,
                         const CameraPathSettings& settings) {
    if (bytes.size() % freed_bytes != 0)
        fail("{} has {} bytes, which is no whole number of FreeD messages of {}", file.string(),
             bytes.size(), freed_bytes);
    require_cameras(bytes.size() / freed_bytes, file);
    CameraPath path{settings.rate_hz.value_or(default_camera_rate_hz), settings.size_px, {}};
    for (std::size_t at = 0; at < bytes.size(); at += freed_bytes) {
        const std::optional<FreedCamera> message = decode_freed(bytes.subspan(at, freed_bytes));
        if (!message)
            fail("{}: message {} is no FreeD D1 with a right checksum and a tilt within 90 degrees",
                 file.string(), at / freed_bytes + 1);
        const std::optional<double> angle_rad = settings.field_of_view_rad
                                                    ? settings.field_of_view_rad
                                                    : freed_field_of_view_rad(*message);
        if (!angle_rad)
            fail(
                "{}: message {} has a zoom of {}, which is no field of view in thousandths of a "
                "degree; say it with --fov",
                file.string(), at / freed_bytes + 1, message->zoom);
        const bool has_focus = message->focus > 0 && !settings.field_of_view_rad;
        path.cameras.push_back({message->world_from_camera, *angle_rad,
                                has_focus ? message->focus / mm : settings.focus_m});
    }
    return path;
}

CameraPathForm freed_form() {
    return {"freed", "NAME.freed, FreeD D1 messages",
            [](const std::filesystem::path& file) { return file.extension() == ".freed"; },
            [](const std::filesystem::path& file, const CameraPathSettings& settings) {
                return freed_path_of(read_file(file, most_cameras * freed_bytes), file, settings);
            },
            [](const CameraPath& path, const std::filesystem::path& file) {
                std::vector<std::byte> bytes;
                for (const CameraState& camera : path.cameras) {
                    const auto message = encode_freed(freed_camera(camera, 1));
                    bytes.insert(bytes.end(), message.begin(), message.end());
                }
                write_file_atomically(file, bytes);
            }};
}

}  // namespace vantage
