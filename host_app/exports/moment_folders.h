#pragma once

#include <filesystem>

#include "host_app/exports/moment.h"

namespace vantage {

// Exports of one moment as a new folder of images, depth maps and cameras. Throw Error if it cannot
// be written.

/// For training radiance fields and Gaussian splats: images/, depth/ (16-bit PNG, millimetres,
/// 0 = unknown), transforms.json (OpenGL's axes) and sparse/0, a COLMAP model as text. In both, the
/// corner of the image is at (0, 0), half a pixel before the centre of the first pixel.
void write_training_folder(const Moment& moment, const std::filesystem::path& folder);
/// A view set for `vantage render --views`.
void write_view_set(const Moment& moment, const std::filesystem::path& folder);

}  // namespace vantage
