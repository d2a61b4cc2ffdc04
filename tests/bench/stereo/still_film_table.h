#pragma once

#include "common/gl/shader_library.h"

namespace vantage {

/// Prints how far the disparities of pixels that stand still flicker on films of the virtual stage,
/// whose performers move, with sensor noise and an exposure that drifts: before and after
/// TemporalPass.
void print_still_film_table(const ShaderLibrary& library);

}  // namespace vantage
