#pragma once

#include <filesystem>

#include "host_app/exports/moment.h"

namespace vantage {

/// Writes one OpenEXR file per rig into a new folder, for compositors: R, G and B as linear light
/// (Rec. 709 primaries, half floats), Z in metres along the camera's axis (floats, 0: unknown), the
/// attribute worldToCamera, and the intrinsics K in px. Throws Error if a file cannot be written.
void write_exr_folder(const Moment& moment, const std::filesystem::path& folder);

}  // namespace vantage
