#pragma once

#include <filesystem>

#include "common/gl/shader_library.h"

namespace vantage {

/// Prints what the presets and HH4 make of the virtual stage: sub-pixel error on slanted planes and
/// what confidence is worth. `picture`: where to write their colour-mapped disparities beside the
/// exact ones (.jpg or .png); empty: nowhere.
void print_stage_tables(const ShaderLibrary& library, const std::filesystem::path& picture);

}  // namespace vantage
