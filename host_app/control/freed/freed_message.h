#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "host_app/flight/camera_state.h"
#include "host_app/flight/pan_tilt_roll.h"

namespace vantage {

/// A camera in a FreeD message of type D1 (Radamec, 1997): x is the stage's x, y its -z, height its
/// y.
struct FreedCamera {
    std::uint8_t id = 1;
    Pose world_from_camera = Pose::Identity();
    std::uint32_t zoom = 0, focus = 0;  ///< 24 bits, of the lens's encoders
};

constexpr std::size_t freed_bytes = 29;
std::array<std::byte, freed_bytes> encode_freed(const FreedCamera& camera);
/// A message as it was read; without a camera, what is wrong with it, for people.
struct FreedReading {
    std::optional<FreedCamera> camera;
    std::string fault;
};
FreedReading read_freed(std::span<const std::byte> message);
/// Nothing: it is no D1, or its checksum is another, or it looks to where there is no direction.
inline std::optional<FreedCamera> decode_freed(std::span<const std::byte> message) {
    return read_freed(message).camera;
}

/// As Vantage says a lens: zoom is the horizontal field of view in thousandths of a degree, focus
/// millimetres.
FreedCamera freed_camera(const CameraState& camera, std::uint8_t id);

/// A field of view from a message whose zoom is said that way; nothing: it is no lens that Vantage
/// has.
std::optional<double> freed_field_of_view_rad(const FreedCamera& camera);

}  // namespace vantage
