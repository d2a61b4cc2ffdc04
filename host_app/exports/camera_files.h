#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <span>

#include "common/take/take_reader.h"
#include "host_app/control/freed/freed_message.h"

namespace vantage {

/// Of a tick.
CameraState camera_of(const CameraRecord& record);

/// A camera in a FreeD message, as freed_camera() says it.
std::array<std::byte, freed_bytes> freed_message(const CameraRecord& camera);

/// A line of text a tick: time code, seconds since the first, position, turn as angles and as a
/// quaternion of world_from_camera (OpenCV's axes), lens.
void write_camera_csv(const TakeReader& take, std::span<const CameraRecord> cameras,
                      const std::filesystem::path& file);
/// The messages one after the other.
void write_camera_freed(std::span<const CameraRecord> cameras, const std::filesystem::path& file);

}  // namespace vantage
