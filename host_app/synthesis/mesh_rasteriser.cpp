#include "host_app/synthesis/mesh_rasteriser.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "host_app/views/projection.h"

namespace vantage {
namespace {

/// Width of a rim beyond the centre of a surface's last pixel: an edge lies half a pixel beyond it
/// on average. From more than this angle aside a body has another outline, and rims get narrower,
/// because the widest rim of all rigs shows.
constexpr double max_rim_px = 0.5, max_rim_angle_rad = 0.07;

/// Returns the rims' width for the angle between the view and the target, px.
double rim_px(const RigSurface& view, const VirtualView& target) {
    const Pose& world_from_camera = view.camera().world_from_camera;
    const Eigen::Vector3d point = world_from_camera * Eigen::Vector3d(0, 0, view.median_depth_m());
    const Eigen::Vector3d a = point - world_from_camera.translation();
    const Eigen::Vector3d b = point - target.world_from_camera.translation();
    const double angle_rad = std::atan2(a.cross(b).norm(), a.dot(b));
    return max_rim_px * std::min(1.0, max_rim_angle_rad / (angle_rad + 1e-9));
}

Program program(const ShaderLibrary& library, MeshRasteriser::Depths depths, const char* rims) {
    const bool is_matted = depths == MeshRasteriser::Depths::matted;
    return Program::render(library, "mesh_depth.vert",
                           is_matted ? "matted_depth.frag" : "depth_only.frag",
                           {{"RIMS", rims}, {"MATTED", is_matted ? "1" : "0"}});
}

}  // namespace

MeshRasteriser::MeshRasteriser(const ShaderLibrary& library, Depths depths)
    : draw_(program(library, depths, "0")), draw_rims_(program(library, depths, "1")) {}

void MeshRasteriser::draw_depth(const RigSurface& view, const VirtualView& target, double near_m,
                                const Framebuffer& depth_only, QuadGrid grid) {
    DepthGrid surface = view.grid(grid);
    if (grid == QuadGrid::fine && view.rims()) {
        surface.rims = view.rims();
        surface.rim_px = rim_px(view, target);
    }
    draw_depth(surface, target, near_m, depth_only);
}

void MeshRasteriser::draw_depth(const DepthGrid& grid, const VirtualView& target, double near_m,
                                const Framebuffer& depth_only) {
    depth_only.bind();
    glDepthMask(GL_TRUE);
    glClearDepthf(1.0f);
    glClear(GL_DEPTH_BUFFER_BIT);
    if (grid.triangles.capacity == 0) return;
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LESS);
    glEnable(GL_CULL_FACE);
    glCullFace(GL_BACK);
    glFrontFace(GL_CCW);
    glDisable(GL_BLEND);
    const Eigen::Matrix4f clip_from_pixel =
        (clip_from_target(target, near_m) *
         target_from_pixel(target, grid.world_from_camera, grid.K))
            .cast<float>();
    const auto prepare = [&](Program& draw) {
        draw.use();
        draw.input("depth_map", grid.depth_m);
        draw.set("clip_from_pixel", clip_from_pixel);
        vertices_.bind();
    };
    prepare(draw_);
    grid.triangles.draw();
    if (grid.rims) {
        prepare(draw_rims_);
        draw_rims_.set("reach_px", static_cast<float>(grid.rim_px));
        grid.rims->draw();
    }
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_CULL_FACE);
}

}  // namespace vantage
