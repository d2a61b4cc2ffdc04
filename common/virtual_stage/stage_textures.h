#pragma once

#include <cstdint>
#include <vector>

#include "common/image/image.h"

namespace vantage {

/// The layers of the stage's texture array. All except the posters tile.
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

/// Draws every layer, display-coded RGBA with stage_texture_side_px sides and detail at all scales.
/// The same seed draws the same images.
std::vector<ColourImage> draw_stage_textures(std::uint64_t seed);

}  // namespace vantage
