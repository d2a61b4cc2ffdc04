#include "host_app/exports/camera_files.h"

#include <chrono>
#include <numbers>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "common/base/files/atomic_file.h"
#include "common/base/time/timecode.h"

namespace vantage {
namespace {

constexpr double deg = 180 / std::numbers::pi;

}  // namespace

CameraState camera_of(const CameraRecord& record) {
    return {record.world_from_camera, record.field_of_view_rad, record.focus_m};
}

std::array<std::byte, freed_bytes> freed_message(const CameraRecord& camera) {
    return encode_freed(freed_camera(camera_of(camera), 1));
}

void write_camera_csv(const TakeReader& take, std::span<const CameraRecord> cameras,
                      const std::filesystem::path& file) {
    const TimecodeClock clock(take.facts().pulse_rate_hz);
    std::string text =
        "tick,pulse,timecode,time_s,x_m,y_m,z_m,pan_deg,tilt_deg,roll_deg,qw,qx,qy,qz,"
        "field_of_view_deg,focus_m\n";
    for (const CameraRecord& camera : cameras) {
        const PanTiltRoll turn = pan_tilt_roll_of(camera.world_from_camera);
        const Eigen::Vector3d at = camera.world_from_camera.translation();
        const Eigen::Quaterniond q(camera.world_from_camera.linear());
        text += fmt::format(
            "{},{},{},{:.6f},{:.6f},{:.6f},{:.6f},{:.6f},{:.6f},{:.6f},{:.9f},{:.9f},{:.9f},{:.9f},"
            "{:.6f},{:.6f}\n",
            camera.tick, camera.pulse, clock.of_pulse(camera.pulse, take.facts().tai_offset_s),
            std::chrono::duration<double>(camera.time - cameras.front().time).count(), at.x(),
            at.y(), at.z(), turn.pan_rad * deg, turn.tilt_rad * deg, turn.roll_rad * deg, q.w(),
            q.x(), q.y(), q.z(), camera.field_of_view_rad * deg, camera.focus_m);
    }
    write_text_atomically(file, text);
}

void write_camera_freed(std::span<const CameraRecord> cameras, const std::filesystem::path& file) {
    std::vector<std::byte> bytes;
    for (const CameraRecord& camera : cameras) {
        const auto message = freed_message(camera);
        bytes.insert(bytes.end(), message.begin(), message.end());
    }
    write_file_atomically(file, bytes);
}

}  // namespace vantage
