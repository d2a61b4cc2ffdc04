#pragma once

#include <vector>

#include "common/gl/shader_library.h"
#include "tests/bench/stereo/random_scene.h"

namespace vantage {

/// Prints errors on surfaces without texture: of `scenes`, and of sets of the virtual stage.
void print_plain_surface_table(const ShaderLibrary& library,
                               const std::vector<StereoScene>& scenes);

}  // namespace vantage
