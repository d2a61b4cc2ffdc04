#include "host_app/surfaces/triangle_builder.h"

#include <algorithm>
#include <string>

#include "common/gl/tile_pass.h"

namespace vantage {
namespace {

/// Slope of a surface against the line of sight from which on a step in depth is an edge.
constexpr double max_slope = 8.0;
/// A smaller share of the depth is never an edge, since disparities are quantised.
constexpr double min_step = 0.0075;

int quads_across(QuadGrid grid) { return grid == QuadGrid::fine ? 1 : 4; }

Program blocks(const ShaderLibrary& library, QuadGrid grid, bool is_in_tiles = false) {
    return Program::compute(library, "mesh_triangles.comp",
                            {{"STEP", std::to_string(static_cast<int>(grid))},
                             {"ACROSS", std::to_string(quads_across(grid))},
                             {"TILES", is_in_tiles ? "1" : "0"}});
}

}  // namespace

TriangleBuilder::TriangleBuilder(const ShaderLibrary& library)
    : build_(blocks(library, QuadGrid::fine)),
      build_coarse_(blocks(library, QuadGrid::coarse)),
      build_parts_(blocks(library, QuadGrid::coarse, true)),
      build_rims_(Program::compute(library, "mesh_rims.comp")) {}

void TriangleBuilder::build(const DepthGrid& grid, float bend) {
    build(grid, bend, grid.grid == QuadGrid::fine ? build_ : build_coarse_);
}

void TriangleBuilder::build_where(const DepthGrid& grid, const Texture& tiles, cv::Size picture,
                                  float bend) {
    build_parts_.use();
    build_parts_.input("tiles", tiles);
    build_parts_.set("tile_share", TilePass::share_of(picture));
    build(grid, bend, build_parts_);
}

void TriangleBuilder::build(const DepthGrid& grid, float bend, Program& program) {
    if (grid.triangles.capacity == 0) return;
    const int block = static_cast<int>(grid.grid) * quads_across(grid.grid);
    set_edge_filter(program, grid);
    program.set("bend", bend * grid.spread);
    grid.triangles.begin();
    const auto blocks = [&](int px) { return (px - 1 + block - 1) / block; };
    program.dispatch_over(blocks(grid.depth_m.width_px()), blocks(grid.depth_m.height_px()));
    glMemoryBarrier(GL_ELEMENT_ARRAY_BARRIER_BIT | GL_COMMAND_BARRIER_BIT);
}

void TriangleBuilder::set_edge_filter(Program& program, const DepthGrid& grid) {
    program.use();
    program.input("depth_map", grid.depth_m);
    // The same for all grids: no coarse quad spans what fine ones would not.
    program.set("tolerance", static_cast<float>(std::max(max_slope / grid.K(0, 0), min_step)));
}

void TriangleBuilder::build_rims(RigSurface& surface) {
    if (triangle_indices(surface.depth().size()) == 0) return;
    const IndirectTriangles& rims = surface.rims_to_build();
    const DepthGrid grid = surface.grid(QuadGrid::fine);
    set_edge_filter(build_rims_, grid);
    build_rims_.set("capacity", rims.capacity);
    rims.begin();
    build_rims_.dispatch_over(grid.depth_m.width_px() - 1, grid.depth_m.height_px() - 1);
    glMemoryBarrier(GL_ELEMENT_ARRAY_BARRIER_BIT | GL_COMMAND_BARRIER_BIT);
}

}  // namespace vantage
