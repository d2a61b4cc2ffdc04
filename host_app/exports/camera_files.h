#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <span>

#include "common/take/take_reader.h"

namespace vantage {

/// Which way a camera looks, as operators say it: about the stage's vertical, to the right; up;
/// clockwise as seen from behind it.
struct PanTiltRoll {
    double pan_rad = 0, tilt_rad = 0, roll_rad = 0;
};
/// Pan 0 looks along the stage's -z.
PanTiltRoll pan_tilt_roll_of(const Pose& world_from_camera);

/// A camera in a FreeD message of type D1 (Radamec, 1997): 29 bytes. x is the stage's x, y its -z,
/// height its y; zoom is the horizontal field of view in thousandths of a degree, focus
/// millimetres.
std::array<std::byte, 29> freed_message(const CameraRecord& camera);

/// A line of text a tick: time code, seconds since the first, position, turn as angles and as a
/// quaternion of world_from_camera (OpenCV's axes), lens.
void write_camera_csv(const TakeReader& take, std::span<const CameraRecord> cameras,
                      const std::filesystem::path& file);
/// The messages one after the other.
void write_camera_freed(std::span<const CameraRecord> cameras, const std::filesystem::path& file);

}  // namespace vantage
