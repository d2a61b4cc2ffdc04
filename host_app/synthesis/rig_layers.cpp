#include "host_app/synthesis/rig_layers.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "host_app/views/depth_view.h"
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

double near_plane_m(std::span<const DrawnLayer> layers) {
    double typical_m = 0;
    for (const DrawnLayer& layer : layers)
        typical_m = std::max(typical_m, layer.surface->median_depth_m());
    return typical_m > 0 ? 0.01 * typical_m : 0.01;
}

void RigLayers::begin(std::span<const DrawnLayer> layers, const VirtualView& target) {
    assert(layers.size() <= max_layers);
    used_.assign(layers.begin(), layers.end());
    target_ = target;
    near_m_ = near_plane_m(layers);
    for (std::size_t i = 0; i < layers.size(); ++i)
        layers_[i].resize({target.width_px, target.height_px});
}

void RigLayers::draw_layer(std::size_t layer, QuadGrid grid) {
    const RigSurface& surface = *used_[layer].surface;
    const bool is_fine = grid == QuadGrid::fine && surface.has_fine_grid();
    rasteriser_.draw_depth(surface, target_, near_m_, layers_[layer].target(),
                           is_fine ? QuadGrid::fine : QuadGrid::coarse);
}

void RigLayers::draw(std::span<const DrawnLayer> layers, const VirtualView& target,
                     std::size_t fine) {
    begin(layers, target);
    for (std::size_t i = 0; i < layers.size(); ++i)
        draw_layer(i, i < fine ? QuadGrid::fine : QuadGrid::coarse);
}

void RigLayers::draw(std::span<const DrawnLayer> layers, const VirtualView& target,
                     const Drawing& drawing) {
    begin(layers, target);
    for (std::size_t i = 0; i < layers.size(); ++i)
        drawing(*layers[i].surface, near_m_, layers_[i].target());
}

void RigLayers::bind(Program& program) const {
    const Pose target_from_world = target_.world_from_camera.inverse();
    for (std::size_t i = 0; i < used_.size(); ++i) {
        const DrawnLayer& layer = used_[i];
        const RigSurface& view = *layer.surface;
        const DepthView& camera = view.camera();
        const Eigen::Vector3d centre = target_from_world * camera.world_from_camera.translation();
        const auto set = [&](const char* name, const auto& value) { program.set(name, i, value); };
        program.input("layer_depth", i, layers_[i].texture());
        program.input("colour", i, view.colour());
        program.input("source_depth", i, view.depth());
        set("pixel_from_target",
            Eigen::Matrix4f(pixel_from_target_pixel(camera, target_).cast<float>()));
        set("colour_size", Eigen::Vector2f(static_cast<float>(view.colour().width_px()),
                                           static_cast<float>(view.colour().height_px())));
        set("centre", Eigen::Vector3f(centre.cast<float>()));
        set("spread", depth_spread(camera));
        set("presence", layer.presence);
    }
    program.set("ray_from_pixel", Eigen::Matrix3f(target_.K.inverse().cast<float>()));
    program.set("near_m", static_cast<float>(near_m_));
}

LayerPass::LayerPass(const ShaderLibrary& library, std::string fragment, float softness,
                     ShaderDefines more, std::size_t layers_per_rig, std::size_t min_layers)
    : library_(&library),
      fragment_(std::move(fragment)),
      softness_(softness),
      more_(std::move(more)) {
    // Compiled at once, since compiling during a flight would stall it.
    for (std::size_t layers = std::max(layers_per_rig, min_layers); layers <= RigLayers::max_layers;
         layers += layers_per_rig)
        plain_[layers - 1].emplace(library, fragment_, defines(layers, false));
}

ShaderDefines LayerPass::defines(std::size_t layers, bool origins) const {
    ShaderDefines all{{"LAYERS", std::to_string(layers)}, {"ORIGINS", origins ? "1" : "0"}};
    all.insert(all.end(), more_.begin(), more_.end());
    return all;
}

FullscreenPass& LayerPass::use(const RigLayers& layers, bool notes_origins) {
    const std::size_t count = layers.used().size();
    std::optional<FullscreenPass>& pass = (notes_origins ? noting_ : plain_)[count - 1];
    if (!pass) pass.emplace(*library_, fragment_, defines(count, notes_origins));
    Program& program = pass->use();
    layers.bind(program);
    program.set("softness", softness_);
    return *pass;
}

}  // namespace vantage
