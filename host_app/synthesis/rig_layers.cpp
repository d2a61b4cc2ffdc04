#include "host_app/synthesis/rig_layers.h"

#include <cassert>

#include <Eigen/LU>
#include <fmt/format.h>

#include "host_app/synthesis/projection.h"
#include "host_app/synthesis/view_ranking.h"

namespace vantage {
namespace {

/// Disparities are trusted to this many pixels.
constexpr double disparity_sigma_px = 0.15;

}  // namespace

float depth_spread(const DepthView& camera) {
    const double f_baseline = camera.K(0, 0) * camera.baseline_m;
    return f_baseline > 0 ? static_cast<float>(disparity_sigma_px / f_baseline) : 0.0f;
}

void RigLayers::draw(std::span<const GpuView* const> views, const VirtualView& target,
                     std::size_t fine) {
    assert(views.size() <= max_layers);
    used_.assign(views.begin(), views.end());
    target_ = target;
    near_m_ = near_plane_m(views);
    for (std::size_t i = 0; i < views.size(); ++i) {
        layers_[i].resize({target.width_px, target.height_px});
        rasteriser_.draw_depth(*views[i], target, near_m_, layers_[i].target(),
                               i < fine ? QuadGrid::fine : QuadGrid::coarse);
    }
}

void RigLayers::bind(Program& program) const {
    const Pose target_from_world = target_.world_from_camera.inverse();
    const int count = static_cast<int>(used_.size());
    for (int i = 0; i < count; ++i) {
        const GpuView& view = *used_[static_cast<std::size_t>(i)];
        const DepthView& camera = view.camera();
        const Eigen::Vector3d centre = target_from_world * camera.world_from_camera.translation();
        const auto set = [&](const char* name, const auto& value) {
            program.set(fmt::format("{}[{}]", name, i), value);
        };
        set("layer_depth", i);
        set("colour", count + i);
        set("source_depth", 2 * count + i);
        set("pixel_from_target",
            Eigen::Matrix4f(pixel_from_target_pixel(camera, target_).cast<float>()));
        set("colour_size", Eigen::Vector2f(static_cast<float>(view.colour().width_px()),
                                           static_cast<float>(view.colour().height_px())));
        set("centre", Eigen::Vector3f(centre.cast<float>()));
        set("spread", depth_spread(camera));
        set("presence", view.presence());
        layers_[static_cast<std::size_t>(i)].texture().bind(i);
        view.trusted_colour().bind(count + i);
        view.surface().bind(2 * count + i);
    }
    program.set("ray_from_pixel", Eigen::Matrix3f(target_.K.inverse().cast<float>()));
    program.set("near_m", static_cast<float>(near_m_));
}

}  // namespace vantage
