#pragma once

#include <cstdint>
#include <vector>

#include <opencv2/core.hpp>

#include "common/image/image.h"

namespace vantage {

/// A corner of a tile: a place in a depth map (px, pixel centres at whole numbers), the inverse
/// depth of the tile's plane there (1/m), and how far an inverse depth of the map may lie from the
/// plane and still belong to the tile (1/m).
struct TileCorner {
    float u_px, v_px, inverse_depth, tolerance;
};

/// A quad of a depth map whose pixels lie on one plane: inverse depth is linear over a plane's
/// picture.
struct DepthTile {
    TileCorner corners[4];  ///< top left, top right, bottom left, bottom right
};

/// Divides a depth map (metres, 0 = none) into planar tiles. A block of 16 px that holds more than
/// two surfaces, or one that bends by more than `tolerance` (1/m), is divided into four, down to
/// 2 px. Each surface of a block gets a tile of its own, one pixel larger than the surface in every
/// direction, so that neighbours overlap; a renderer keeps of it what is near enough to the map's
/// own depth.
std::vector<DepthTile> planar_tiles(const DepthImage& depth_m, float tolerance);

/// A coarse surface without holes behind all surfaces of a depth map: connected quads of
/// `cell_px`, at the farther depth where a cell has several, and continued from around where it has
/// none. Empty if the map has no depth at all.
std::vector<DepthTile> backdrop_tiles(const DepthImage& depth_m, int cell_px);

/// Alpha of colours for places that no rig has seen; those of seen places have more than 127.
inline constexpr std::uint8_t never_seen_alpha = 64;

/// The colours of backdrop_tiles(): for each cell the mean of its farther pixels (rgba8, alpha
/// never_seen_alpha), continued where a cell has none.
ColourImage backdrop_colours(const ColourImage& colour, const DepthImage& depth_m, int cell_px);

}  // namespace vantage
