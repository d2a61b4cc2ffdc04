#pragma once

#include <filesystem>

#include "host_app/exports/moment.h"

namespace vantage {

// Exports of one moment as coloured points and surfaces in metres, written atomically. Throw Error
// if the file cannot be written.

/// Stanford's polygon format (PLY), binary, in the stage's world frame (y up): points only...
void write_ply(const std::vector<SurfacePoint>& points, const std::filesystem::path& file);
/// ...and points with surfaces.
void write_ply(const Moment& moment, const std::filesystem::path& file);
/// glTF 2.0 in one file: an unlit primitive of triangles in the stage's world frame.
void write_glb(const Moment& moment, const std::filesystem::path& file);

}  // namespace vantage
