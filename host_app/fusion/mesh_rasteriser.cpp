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
      draw_(Program::render(library, "mesh_depth.vert", "depth_only.frag")) {}

void MeshRasteriser::build_triangles(const GpuView& view) {
    if (view.triangle_indices() == 0) return;
    const double f_px = view.K_depth()(0, 0);
    build_.use();
    build_.set("depth_map", 0);
    build_.set("tolerance", static_cast<float>(std::max(steepest_slope / f_px, smallest_step)));
    view.surface().bind(0);
    view.triangles().bind_storage(0);
    build_.dispatch_over(view.depth().width_px() - 1, view.depth().height_px() - 1);
    glMemoryBarrier(GL_ELEMENT_ARRAY_BARRIER_BIT);
}

void MeshRasteriser::draw_depth(const GpuView& view, const VirtualView& target, double near_m,
                                const Framebuffer& depth_only) {
    depth_only.bind();
    glDepthMask(GL_TRUE);
    glClearDepthf(1.0f);
    glClear(GL_DEPTH_BUFFER_BIT);
    if (view.triangle_indices() == 0) return;
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
    view.triangles().bind(GL_ELEMENT_ARRAY_BUFFER);
    glDrawElements(GL_TRIANGLES, view.triangle_indices(), GL_UNSIGNED_INT, nullptr);
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_CULL_FACE);
}

}  // namespace vantage
