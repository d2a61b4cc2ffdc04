#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "host_app/flight/camera_state.h"
#include "host_app/flight/orbit_view.h"

namespace vantage {

/// A camera in a FreeD message of type D1 (Radamec, 1997). FreeD's x is the world's x, its y is -z,
/// and its height is y.
struct FreedCamera {
    std::uint8_t id = 1;
    Pose world_from_camera = Pose::Identity();
    std::uint32_t zoom = 0, focus = 0;  ///< 24 bits each, from the encoders of the lens
};

constexpr std::size_t freed_bytes = 29;
std::array<std::byte, freed_bytes> encode_freed(const FreedCamera& camera);
/// Result of reading a message: its camera, or a sentence about what is wrong with it.
struct FreedReading {
    std::optional<FreedCamera> camera;
    std::string fault;
};
FreedReading read_freed(std::span<const std::byte> message);
/// Empty if the message is not a D1, its checksum is wrong, or its tilt is beyond the vertical.
inline std::optional<FreedCamera> decode_freed(std::span<const std::byte> message) {
    return read_freed(message).camera;
}

/// A FreeD camera with the lens units of Vantage: zoom is the horizontal field of view in
/// thousandths of a degree, and focus is in millimetres.
FreedCamera freed_camera(const CameraState& camera, std::uint8_t id);

/// The field of view of a message with these units; empty if it is outside the limits of Vantage.
std::optional<double> freed_field_of_view_rad(const FreedCamera& camera);

}  // namespace vantage
