#include "host_app/exports/camera_files.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "common/base/atomic_file.h"
#include "common/base/timecode.h"

namespace vantage {
namespace {

constexpr double deg = 180 / std::numbers::pi;

/// 24 bits, the highest first; what does not fit stays at the limit.
void put_24_bits(std::byte* at, double value) {
    constexpr double most = (1 << 23) - 1;
    const auto bits = static_cast<std::uint32_t>(
        static_cast<std::int32_t>(std::lround(std::clamp(value, -most, most))));
    at[0] = static_cast<std::byte>(bits >> 16 & 0xff);
    at[1] = static_cast<std::byte>(bits >> 8 & 0xff);
    at[2] = static_cast<std::byte>(bits & 0xff);
}

}  // namespace

PanTiltRoll pan_tilt_roll_of(const Pose& world_from_camera) {
    const Eigen::Vector3d right = world_from_camera.linear().col(0);
    const Eigen::Vector3d forward = world_from_camera.linear().col(2);
    PanTiltRoll turn;
    turn.pan_rad = std::atan2(forward.x(), -forward.z());
    turn.tilt_rad = std::asin(std::clamp(forward.y(), -1.0, 1.0));
    const Eigen::Vector3d level(std::cos(turn.pan_rad), 0, std::sin(turn.pan_rad));
    turn.roll_rad = std::atan2(-right.dot(level.cross(forward)), right.dot(level));
    return turn;
}

std::array<std::byte, 29> freed_message(const CameraRecord& camera) {
    constexpr double steps_a_degree = 32768, steps_a_mm = 64, mm = 1000, per_thousand = 1000;
    const PanTiltRoll turn = pan_tilt_roll_of(camera.world_from_camera);
    const Eigen::Vector3d at = camera.world_from_camera.translation();
    std::array<std::byte, 29> bytes{};
    bytes[0] = std::byte{0xd1};
    bytes[1] = std::byte{1};
    put_24_bits(&bytes[2], turn.pan_rad * deg * steps_a_degree);
    put_24_bits(&bytes[5], turn.tilt_rad * deg * steps_a_degree);
    put_24_bits(&bytes[8], turn.roll_rad * deg * steps_a_degree);
    put_24_bits(&bytes[11], at.x() * mm * steps_a_mm);
    put_24_bits(&bytes[14], -at.z() * mm * steps_a_mm);
    put_24_bits(&bytes[17], at.y() * mm * steps_a_mm);
    put_24_bits(&bytes[20], camera.field_of_view_rad * deg * per_thousand);
    put_24_bits(&bytes[23], camera.focus_m * mm);
    unsigned sum = 0x40;
    for (std::size_t i = 0; i + 1 < bytes.size(); ++i) sum -= std::to_integer<unsigned>(bytes[i]);
    bytes.back() = static_cast<std::byte>(sum & 0xff);
    return bytes;
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
    write_file_atomically(file, std::as_bytes(std::span(text)));
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
