#pragma once

#include <string>

#include "common/gl/shader_library.h"

namespace vantage {

/// A Markdown table of the picture midway between rigs of the virtual stage, its demo's set and
/// generated ones: `fused` from exact depth, and from what the rigs' own matcher (`quality`) makes
/// of pictures with sensor noise, denoised over time as the daemon does; and how much the picture
/// flickers while the stage stands still. Needs a current context.
std::string own_matching_table(const ShaderLibrary& library);

}  // namespace vantage
