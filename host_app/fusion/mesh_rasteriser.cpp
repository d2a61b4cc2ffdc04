#include "host_app/fusion/mesh_rasteriser.h"

#include <algorithm>

#include "host_app/fusion/projection.h"

namespace vantage {
namespace {

/// Steeper than this against the line of sight, a step in depth is taken for two surfaces.
constexpr double steepest_slope = 8.0;
/// A step below this share of the depth never is (depth codes are quantised).
constexpr double smallest_step = 0.0075;

DepthGrid surface_of(const GpuView& view, QuadGrid grid) {
    return {view.surface(), view.triangles(grid), view.K_depth(), view.camera().world_from_camera,
            grid};
}

}  // namespace

MeshRasteriser::MeshRasteriser(const ShaderLibrary& library)
    : build_(Program::compute(library, "mesh_triangles.comp")),
      build_coarse_(
          Program::compute(library, "mesh_triangles.comp",
                           {{"STEP", std::to_string(static_cast<int>(QuadGrid::coarse))}})),
      draw_(Program::render(library, "mesh_depth.vert", "depth_only.frag")) {}

void MeshRasteriser::build_triangles(const GpuView& view, QuadGrid grid) {
    build_triangles(surface_of(view, grid));
}

void MeshRasteriser::build_triangles(const DepthGrid& grid) {
    if (triangle_indices(grid.depth_m.size(), grid.grid) == 0) return;
    const int step = static_cast<int>(grid.grid);
    Program& build = grid.grid == QuadGrid::fine ? build_ : build_coarse_;
    build.use();
    build.set("depth_map", 0);
    // The same for both: a coarse quad that a fine one would not span is left out.
    build.set("tolerance",
              static_cast<float>(std::max(steepest_slope / grid.K(0, 0), smallest_step)));
    grid.depth_m.bind(0);
    grid.triangles.bind_storage(0);
    build.dispatch_over((grid.depth_m.width_px() - 1) / step,
                        (grid.depth_m.height_px() - 1) / step);
    glMemoryBarrier(GL_ELEMENT_ARRAY_BARRIER_BIT);
}

void MeshRasteriser::draw_depth(const GpuView& view, const VirtualView& target, double near_m,
                                const Framebuffer& depth_only, QuadGrid grid) {
    draw_depth(surface_of(view, grid), target, near_m, depth_only);
}

void MeshRasteriser::draw_depth(const DepthGrid& grid, const VirtualView& target, double near_m,
                                const Framebuffer& depth_only) {
    depth_only.bind();
    glDepthMask(GL_TRUE);
    glClearDepthf(1.0f);
    glClear(GL_DEPTH_BUFFER_BIT);
    const int indices = triangle_indices(grid.depth_m.size(), grid.grid);
    if (indices == 0) return;
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LESS);
    glEnable(GL_CULL_FACE);
    glCullFace(GL_BACK);
    glFrontFace(GL_CCW);
    glDisable(GL_BLEND);
    draw_.use();
    draw_.set("depth_map", 0);
    draw_.set("clip_from_pixel",
              Eigen::Matrix4f((clip_from_target(target, near_m) *
                               target_from_pixel(target, grid.world_from_camera, grid.K))
                                  .cast<float>()));
    grid.depth_m.bind(0);
    vertices_.bind();
    grid.triangles.bind(GL_ELEMENT_ARRAY_BUFFER);
    glDrawElements(GL_TRIANGLES, indices, GL_UNSIGNED_INT, nullptr);
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_CULL_FACE);
}

}  // namespace vantage
