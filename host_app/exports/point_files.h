#pragma once

#include <filesystem>

#include "host_app/exports/moment.h"

namespace vantage {

// What the rigs saw as coloured points and the surfaces between them, in metres; not there, or
// whole. Throw Error if the file cannot be written.

/// Stanford's polygon format (PLY), binary. World as the stage's: y up. Of points alone...
void write_ply(const std::vector<SurfacePoint>& points, const std::filesystem::path& file);
/// ...and with surfaces.
void write_ply(const Moment& moment, const std::filesystem::path& file);
/// glTF 2.0 in one file, a primitive of triangles without light; its axes are the stage's.
void write_glb(const Moment& moment, const std::filesystem::path& file);

}  // namespace vantage
