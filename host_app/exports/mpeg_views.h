#pragma once

#include <filesystem>

#include "host_app/exports/moment.h"

namespace vantage {

/// An MPEG view set of one frame, as TMIV and RVS read it: sequence.json with the cameras, axes of
/// OMAF, and of every rig NAME_texture_WxH_yuv420p10le.yuv and NAME_depth_WxH_yuv420p16le.yuv.
/// Depth is inverse, 1 (farthest) to 65535 (nearest) over the range that sequence.json says, 0
/// where it is unknown. An odd last row or column is left out. Throws Error if no rig has depth, or
/// if it cannot be written; `folder` is made.
void write_mpeg_views(const Moment& moment, const std::filesystem::path& folder);

}  // namespace vantage
