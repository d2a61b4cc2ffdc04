#pragma once

#include <filesystem>

#include "host_app/exports/moment.h"

namespace vantage {

// What the rigs saw at one moment as a folder of pictures with depth and cameras. Throw Error if it
// cannot be written; `folder` is made.

/// For what trains radiance fields and Gaussian splats: images/, depth/ (16-bit PNG, millimetres,
/// 0 = unknown), transforms.json (axes of OpenGL) and sparse/0, a COLMAP model as text. Both put a
/// picture's corner at 0, 0, half a pixel before the centre of the first.
void write_training_folder(const Moment& moment, const std::filesystem::path& folder);
/// As `vantage render --views` reads it.
void write_view_set(const Moment& moment, const std::filesystem::path& folder);

}  // namespace vantage
