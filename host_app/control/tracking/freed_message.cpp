#include "host_app/control/tracking/freed_message.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "host_app/flight/orbit_view.h"

namespace vantage {
namespace {

constexpr double deg = 180 / std::numbers::pi;
constexpr double steps_per_degree = 32768, steps_per_mm = 64, mm = 1000, per_thousand = 1000;
constexpr std::byte type_d1{0xd1};

/// Writes 24 bits, the most significant byte first; values are clamped.
void put_24_bits(std::byte* at, double value, double limit = (1 << 23) - 1) {
    const auto bits = static_cast<std::uint32_t>(
        static_cast<std::int32_t>(std::lround(std::clamp(value, -limit, limit))));
    at[0] = static_cast<std::byte>(bits >> 16 & 0xff);
    at[1] = static_cast<std::byte>(bits >> 8 & 0xff);
    at[2] = static_cast<std::byte>(bits & 0xff);
}

std::uint32_t unsigned_24_bits(const std::byte* at) {
    return std::to_integer<std::uint32_t>(at[0]) << 16 |
           std::to_integer<std::uint32_t>(at[1]) << 8 | std::to_integer<std::uint32_t>(at[2]);
}

double signed_24_bits(const std::byte* at) {
    const auto bits = static_cast<std::int32_t>(unsigned_24_bits(at));
    return bits >= 1 << 23 ? bits - (1 << 24) : bits;
}

std::byte checksum_of(std::span<const std::byte> message) {
    unsigned sum = 0x40;
    for (const std::byte byte : message.first(freed_bytes - 1))
        sum -= std::to_integer<unsigned>(byte);
    return static_cast<std::byte>(sum & 0xff);
}

}  // namespace

std::array<std::byte, freed_bytes> encode_freed(const FreedCamera& camera) {
    const PanTiltRoll turn = pan_tilt_roll_of(camera.world_from_camera);
    const Eigen::Vector3d at = camera.world_from_camera.translation();
    std::array<std::byte, freed_bytes> bytes{};
    bytes[0] = type_d1;
    bytes[1] = std::byte{camera.id};
    put_24_bits(&bytes[2], turn.pan_rad * deg * steps_per_degree);
    put_24_bits(&bytes[5], turn.tilt_rad * deg * steps_per_degree);
    put_24_bits(&bytes[8], turn.roll_rad * deg * steps_per_degree);
    put_24_bits(&bytes[11], at.x() * mm * steps_per_mm);
    put_24_bits(&bytes[14], -at.z() * mm * steps_per_mm);
    put_24_bits(&bytes[17], at.y() * mm * steps_per_mm);
    constexpr double max_lens = (1 << 24) - 1;
    put_24_bits(&bytes[20], camera.zoom, max_lens);
    put_24_bits(&bytes[23], camera.focus, max_lens);
    bytes.back() = checksum_of(bytes);
    return bytes;
}

FreedReading read_freed(std::span<const std::byte> message) {
    const auto number = [](std::byte byte) { return std::to_integer<unsigned>(byte); };
    if (message.size() != freed_bytes)
        return {
            {},
            fmt::format("{} bytes, where a FreeD D1 message has {}", message.size(), freed_bytes)};
    if (message[0] != type_d1)
        return {{},
                fmt::format("a message of type 0x{:02x}, where FreeD D1 has 0x{:02x}",
                            number(message[0]), number(type_d1))};
    if (message.back() != checksum_of(message))
        return {{},
                fmt::format("a FreeD message with the checksum 0x{:02x}, where its bytes give "
                            "0x{:02x}",
                            number(message.back()), number(checksum_of(message)))};
    const auto angle_rad = [&](int at) {
        return signed_24_bits(&message[static_cast<std::size_t>(at)]) / steps_per_degree / deg;
    };
    const auto metres = [&](int at) {
        return signed_24_bits(&message[static_cast<std::size_t>(at)]) / steps_per_mm / mm;
    };
    PanTiltRoll turn{angle_rad(2), angle_rad(5), angle_rad(8)};
    // A head that stands upright may round to a step or two beyond it.
    constexpr double zenith_rad = std::numbers::pi / 2, rounding_rad = 0.1 / deg;
    if (std::abs(turn.tilt_rad) > zenith_rad + rounding_rad)
        return {{},
                fmt::format("a FreeD message with a tilt of {:.2f} degrees, which is beyond 90",
                            turn.tilt_rad * deg)};
    turn.tilt_rad = std::clamp(turn.tilt_rad, -zenith_rad, zenith_rad);
    FreedCamera camera;
    camera.id = std::to_integer<std::uint8_t>(message[1]);
    camera.world_from_camera.linear() = turned(turn);
    camera.world_from_camera.translation() = Eigen::Vector3d(metres(11), metres(17), -metres(14));
    camera.zoom = unsigned_24_bits(&message[20]);
    camera.focus = unsigned_24_bits(&message[23]);
    return {camera, {}};
}

FreedCamera freed_camera(const CameraState& camera, std::uint8_t id) {
    const auto lens = [](double value) {
        constexpr double max_lens = (1 << 24) - 1;
        return static_cast<std::uint32_t>(std::lround(std::clamp(value, 0.0, max_lens)));
    };
    return {id, camera.world_from_camera, lens(camera.field_of_view_rad * deg * per_thousand),
            lens(camera.focus_m * mm)};
}

std::optional<double> freed_field_of_view_rad(const FreedCamera& camera) {
    const double angle_rad = camera.zoom / per_thousand / deg;
    const FlightLimits limits;
    if (angle_rad < limits.min_field_of_view_rad || angle_rad > limits.max_field_of_view_rad)
        return std::nullopt;
    return angle_rad;
}

}  // namespace vantage
