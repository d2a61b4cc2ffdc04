#include "host_app/synthesis/rig_layers.h"

#include <algorithm>
#include <cassert>

#include <Eigen/LU>

#include "host_app/views/depth_view.h"
#include "host_app/views/projection.h"

namespace vantage {
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

}  // namespace vantage
