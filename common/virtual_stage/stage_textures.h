#pragma once

#include <cstdint>
#include <vector>

#include "common/image/image.h"

namespace vantage {

/// The layers of the stage's texture array. All but the posters tile.
enum class StageTexture {
    plain,
    wood,
    carpet,
    checker,
    brick,
    plaster,
    plaid,
    stripes,
    flowers,
    denim,
    poster_shapes,
    poster_skyline,
    poster_logo,
    tiles,
    metal,
    speckle,
};

inline constexpr int stage_texture_count = 16;
inline constexpr int stage_texture_side_px = 512;

/// Draws every layer, stage_texture_side_px square, display-coded RGBA; detail at all scales. The
/// same seed draws the same pictures.
std::vector<ColourImage> draw_stage_textures(std::uint64_t seed);

}  // namespace vantage
