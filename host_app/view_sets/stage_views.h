#pragma once

#include <filesystem>

#include "host_app/view_sets/view_set.h"

namespace vantage {

/// The single cameras [[cameras]] of a stage file as a view set, without the distortion of their
/// lenses: their pictures, or the first pictures of their videos, and their outlines. Throws Error
/// naming the camera for what is missing or of another size.
ViewSet load_stage_views(const std::filesystem::path& stage);

}  // namespace vantage
