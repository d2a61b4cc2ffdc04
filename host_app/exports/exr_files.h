#pragma once

#include <filesystem>

#include "host_app/exports/moment.h"

namespace vantage {

/// An OpenEXR file a rig, for compositors: R, G and B as linear light (Rec. 709 primaries, half
/// floats), Z as metres along the camera's axis (floats, 0: unknown), the attribute worldToCamera
/// as the format says, and K, the camera's intrinsics in px. Throws Error if one cannot be written;
/// `folder` is made.
void write_exr_folder(const Moment& moment, const std::filesystem::path& folder);

}  // namespace vantage
