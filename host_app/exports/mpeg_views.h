#pragma once

#include <filesystem>

#include "host_app/exports/moment.h"

namespace vantage {

/// Writes an MPEG view set of one frame for TMIV and RVS into a new folder: sequence.json with the
/// cameras (OMAF's axes), and per rig NAME_texture_WxH_yuv420p10le.yuv and
/// NAME_depth_WxH_yuv420p16le.yuv. Depth is inverse, 1 (farthest) to 65535 (nearest) over the range
/// in sequence.json, 0 if unknown. An odd last row or column is cut off. Throws Error if no rig has
/// depth, or a file cannot be written.
void write_mpeg_views(const Moment& moment, const std::filesystem::path& folder);

}  // namespace vantage
