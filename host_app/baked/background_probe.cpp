#include "host_app/baked/background_probe.h"

#include <algorithm>
#include <utility>

namespace vantage {
namespace {

/// Parallax by which a tile may be wrong in the views that a probe is for.
constexpr double tile_error_px = 0.6;
/// Pixels of a probe for each cell of its backdrop.
constexpr int backdrop_cell_px = 16;
/// Pixels that a surface is continued by into a hole, from each side.
constexpr int widest_filled_px = 12;

DepthImage inverse_of(const DepthImage& depth_m) {
    DepthImage inverse(depth_m.size(), 0.0f);
    for (int y = 0; y < depth_m.rows; ++y)
        for (int x = 0; x < depth_m.cols; ++x)
            if (depth_m(y, x) > 0) inverse(y, x) = 1 / depth_m(y, x);
    return inverse;
}

BackgroundProbe::Part part_of(std::size_t first, std::size_t tiles, const ColourImage& colour,
                              const DepthImage& inverse, float cell_px, bool is_guessed) {
    BackgroundProbe::Part part{
        first,
        tiles,
        Texture(TextureFormat::rgba8, colour.cols, colour.rows, Filter::linear),
        Texture(TextureFormat::r32f, inverse.cols, inverse.rows),
        cell_px,
        is_guessed};
    part.colour.upload(colour);
    part.inverse_depth.upload(inverse);
    return part;
}

Buffer vertices_of(const ProbeTiles& probe) { return Buffer::of(std::span(probe.tiles)); }

Buffer indices_of(const ProbeTiles& probe) {
    std::vector<std::uint32_t> indices;
    indices.reserve(6 * probe.tiles.size());
    for (std::size_t i = 0; i < probe.tiles.size(); ++i)
        for (const unsigned k : {0U, 2U, 1U, 1U, 2U, 3U})
            indices.push_back(4 * static_cast<std::uint32_t>(i) + k);
    return Buffer::of(std::span<const std::uint32_t>(indices));
}

/// Returns the distances of the places that have a colour.
DepthImage distances_of(const ColourImage& colour, const DepthImage& depth_m) {
    DepthImage distance_m = cv::abs(depth_m);
    for (int y = 0; y < distance_m.rows; ++y)
        for (int x = 0; x < distance_m.cols; ++x)
            if (colour(y, x)[3] == 0) distance_m(y, x) = 0;
    return distance_m;
}

/// Continues surfaces into the holes around them, up to `widest_filled_px` from each side. Holes
/// lie beside depth edges: of the surfaces around a pixel the farthest one is continued, and is
/// marked as never seen.
void fill_holes(ColourImage& colour, DepthImage& depth_m) {
    const cv::Rect all({}, depth_m.size());
    std::vector<cv::Point> holes;
    for (int y = 0; y < depth_m.rows; ++y)
        for (int x = 0; x < depth_m.cols; ++x)
            if (depth_m(y, x) == 0) holes.emplace_back(x, y);
    for (int step = 0; step < widest_filled_px && !holes.empty(); ++step) {
        std::vector<std::pair<cv::Point, cv::Point>> filled;  // a hole and its source
        std::erase_if(holes, [&](cv::Point hole) {
            cv::Point source = hole;
            for (const cv::Point off : {cv::Point(-1, 0), {1, 0}, {0, -1}, {0, 1}})
                if (all.contains(hole + off) && depth_m(hole + off) > depth_m(source))
                    source = hole + off;
            if (source == hole) return false;
            filled.emplace_back(hole, source);
            return true;
        });
        for (const auto& [hole, source] : filled) {
            depth_m(hole) = depth_m(source);
            colour(hole) = colour(source);
            colour(hole)[3] = never_seen_alpha;
        }
    }
}

}  // namespace

ProbeTiles probe_tiles(const VirtualView& view, const ColourImage& colour,
                       const DepthImage& depth_m, double parallax_px_m) {
    DepthImage distance_m = distances_of(colour, depth_m);
    ColourImage filled = colour.clone();
    fill_holes(filled, distance_m);
    ProbeTiles probe{
        .view = view,
        .tiles = planar_tiles(distance_m,
                              static_cast<float>(tile_error_px / std::max(parallax_px_m, 1e-3))),
        .inverse_depth = inverse_of(distance_m),
        .colour = filled,
        .backdrop = backdrop_colours(filled, distance_m, backdrop_cell_px)};
    probe.surface_tiles = probe.tiles.size();
    const std::vector<DepthTile> backdrop = backdrop_tiles(distance_m, backdrop_cell_px);
    probe.tiles.insert(probe.tiles.end(), backdrop.begin(), backdrop.end());
    // A view of nothing has one tile that is never drawn: buffers are never empty.
    if (probe.tiles.empty()) probe.tiles.emplace_back();
    return probe;
}

BackgroundProbe::BackgroundProbe(const ProbeTiles& tiles)
    : view_(tiles.view),
      surfaces_(part_of(0, tiles.surface_tiles, tiles.colour, tiles.inverse_depth, 1, false)),
      backdrop_(part_of(tiles.surface_tiles, tiles.tiles.size() - tiles.surface_tiles,
                        tiles.backdrop, DepthImage(1, 1, 1.0f), backdrop_cell_px, true)),
      vertices_(vertices_of(tiles)),
      indices_(indices_of(tiles)) {}

}  // namespace vantage
