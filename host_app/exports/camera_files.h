#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <span>

#include "common/take/take_reader.h"
#include "host_app/control/tracking/freed_message.h"

namespace vantage {

/// The camera of a programme tick.
CameraState camera_of(const CameraRecord& record);

/// The FreeD message of a tick's camera.
std::array<std::byte, freed_bytes> freed_message(const CameraRecord& camera);

/// Writes one line per tick: time code, seconds since the first tick, position, rotation as angles
/// and as a quaternion of world_from_camera (OpenCV's axes), and lens.
void write_camera_csv(const TakeReader& take, std::span<const CameraRecord> cameras,
                      const std::filesystem::path& file);
/// Writes the FreeD messages of all ticks in sequence.
void write_camera_freed(std::span<const CameraRecord> cameras, const std::filesystem::path& file);

}  // namespace vantage
