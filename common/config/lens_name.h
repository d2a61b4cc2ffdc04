#pragma once

#include <optional>
#include <string_view>

#include "common/geometry/camera_model.h"

namespace vantage {

/// The name of a lens model in calibration files, and the model of a name; empty if unknown.
const char* lens_name(LensModel lens);
std::optional<LensModel> lens_named(std::string_view name);

}  // namespace vantage
