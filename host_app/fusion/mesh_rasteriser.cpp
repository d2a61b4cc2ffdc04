#include "host_app/fusion/mesh_rasteriser.h"

#include <algorithm>

#include "host_app/fusion/projection.h"

namespace vantage {
namespace {

/// Steeper than this against the line of sight, a step in depth is taken for two surfaces.
constexpr double steepest_slope = 8.0;
/// A step below this share of the depth never is (depth codes are quantised).
constexpr double smallest_step = 0.0075;

}  // namespace

MeshRasteriser::MeshRasteriser(const ShaderLibrary& library)
    : build_(Program::compute(library, "mesh_triangles.comp")),
      build_coarse_(
          Program::compute(library, "mesh_triangles.comp",
                           {{"STEP", std::to_string(static_cast<int>(QuadGrid::coarse))}})),
      draw_(Program::render(library, "mesh_depth.vert", "depth_only.frag")) {}

void MeshRasteriser::build_triangles(const GpuView& view, QuadGrid grid) {
    if (view.triangle_indices(grid) == 0) return;
    const int step = static_cast<int>(grid);
    const double f_px = view.K_depth()(0, 0);
    Program& build = grid == QuadGrid::fine ? build_ : build_coarse_;
    build.use();
    build.set("depth_map", 0);
    // The same for both: a coarse quad that a fine one would not span is left out.
    build.set("tolerance", static_cast<float>(std::max(steepest_slope / f_px, smallest_step)));
    view.surface().bind(0);
    view.triangles(grid).bind_storage(0);
    build.dispatch_over((view.depth().width_px() - 1) / step,
                        (view.depth().height_px() - 1) / step);
    glMemoryBarrier(GL_ELEMENT_ARRAY_BARRIER_BIT);
}

void MeshRasteriser::draw_depth(const GpuView& view, const VirtualView& target, double near_m,
                                const Framebuffer& depth_only, QuadGrid grid) {
    depth_only.bind();
    glDepthMask(GL_TRUE);
    glClearDepthf(1.0f);
    glClear(GL_DEPTH_BUFFER_BIT);
    if (view.triangle_indices(grid) == 0) return;
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LESS);
    glEnable(GL_CULL_FACE);
    glCullFace(GL_BACK);
    glFrontFace(GL_CCW);
    glDisable(GL_BLEND);
    draw_.use();
    draw_.set("depth_map", 0);
    draw_.set(
        "clip_from_pixel",
        Eigen::Matrix4f((clip_from_target(target, near_m) *
                         target_from_pixel(target, view.camera().world_from_camera, view.K_depth()))
                            .cast<float>()));
    view.surface().bind(0);
    vertices_.bind();
    view.triangles(grid).bind(GL_ELEMENT_ARRAY_BUFFER);
    glDrawElements(GL_TRIANGLES, view.triangle_indices(grid), GL_UNSIGNED_INT, nullptr);
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_CULL_FACE);
}

}  // namespace vantage
