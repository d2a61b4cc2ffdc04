#pragma once

namespace vantage {

// The tolerances of shaders/shared/tolerances.glsl, which has their meanings, as constants.
#define TOLERANCE(name, value) inline constexpr float name = static_cast<float>(value);
#include "shaders/shared/tolerances.glsl"

}  // namespace vantage
