#include "host_app/instants/triangle_builder.h"

#include <algorithm>
#include <array>
#include <cstdint>

namespace vantage {
namespace {

/// Steeper than this against the line of sight, a step in depth is taken for two surfaces.
constexpr double steepest_slope = 8.0;
/// A step below this share of the depth never is (depth codes are quantised).
constexpr double smallest_step = 0.0075;

}  // namespace

TriangleBuilder::TriangleBuilder(const ShaderLibrary& library)
    : build_(Program::compute(library, "mesh_triangles.comp")),
      build_coarse_(
          Program::compute(library, "mesh_triangles.comp",
                           {{"STEP", std::to_string(static_cast<int>(QuadGrid::coarse))}})),
      build_rims_(Program::compute(library, "mesh_rims.comp")) {}

void TriangleBuilder::build(const DepthGrid& grid) {
    if (triangle_indices(grid.depth_m.size(), grid.grid) == 0) return;
    const int step = static_cast<int>(grid.grid);
    Program& build = grid.grid == QuadGrid::fine ? build_ : build_coarse_;
    set_edge_filter(build, grid);
    grid.triangles.bind_storage(0);
    build.dispatch_over((grid.depth_m.width_px() - 1) / step,
                        (grid.depth_m.height_px() - 1) / step);
    glMemoryBarrier(GL_ELEMENT_ARRAY_BARRIER_BIT);
}

void TriangleBuilder::set_edge_filter(Program& program, const DepthGrid& grid) {
    program.use();
    program.set("depth_map", 0);
    // The same for all grids: a coarse quad that a fine one would not span is left out.
    program.set("tolerance",
                static_cast<float>(std::max(steepest_slope / grid.K(0, 0), smallest_step)));
    grid.depth_m.bind(0);
}

void TriangleBuilder::build_rims(RigSurface& surface) {
    if (surface.triangle_indices() == 0) return;
    const SurfaceRims& rims = surface.rims_to_build();
    const std::array<std::uint32_t, 5> empty = {0, 1, 0, 0, 0};
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, rims.command.name());
    glBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, sizeof(empty), empty.data());
    const DepthGrid grid = surface.grid(QuadGrid::fine);
    set_edge_filter(build_rims_, grid);
    build_rims_.set("capacity", rims.capacity);
    rims.indices.bind_storage(0);
    rims.command.bind_storage(1);
    build_rims_.dispatch_over(grid.depth_m.width_px() - 1, grid.depth_m.height_px() - 1);
    glMemoryBarrier(GL_ELEMENT_ARRAY_BARRIER_BIT | GL_COMMAND_BARRIER_BIT);
}

}  // namespace vantage
