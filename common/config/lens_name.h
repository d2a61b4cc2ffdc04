#pragma once

#include <optional>
#include <string_view>

#include "common/geometry/camera_model.h"

namespace vantage {

/// A lens as calibration files name it, and the lens of that name; nothing for any other name.
const char* lens_name(LensModel lens);
std::optional<LensModel> lens_named(std::string_view name);

}  // namespace vantage
