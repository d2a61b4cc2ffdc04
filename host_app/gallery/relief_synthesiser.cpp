#include <algorithm>
#include <memory>
#include <vector>

#include <Eigen/LU>

#include "host_app/gallery/relief_warp.h"
#include "host_app/pipeline/instant_preparer.h"
#include "host_app/synthesis/layer_blender.h"
#include "host_app/synthesis/rig_layers.h"
#include "host_app/synthesis/synthesiser.h"
#include "host_app/views/depth_view.h"
#include "host_app/views/projection.h"
#include "host_app/views/tolerances.h"

namespace vantage {
namespace {

/// Range of depth in which lines of sight are searched, relative to the rig's typical depth.
constexpr double nearest_share = 0.3, farthest_share = 4;

/// Relief texture mapping (Oliveira et al., 2000): every rig's picture with depth is pre-warped in
/// two 1-D passes and then mapped onto a plane as any texture.
class PrewarpRenderer final : public ViewRenderer {
  public:
    explicit PrewarpRenderer(const ShaderLibrary& library) : filler_(library) {
        for (std::size_t i = 0; i < most_drawn_rigs; ++i) {
            warps_.emplace_back(library);
            compose_.emplace_back(library, "relief_compose.frag",
                                  ShaderDefines{{"LAYERS", std::to_string(i + 1)}});
        }
    }

    const Texture& render(const Instant& instant, const VirtualView& view,
                          const RenderLevel& level) override {
        const std::vector<DrawnLayer> layers = layers_of(instant, view, level.rigs);
        composed_.resize({view.width_px, view.height_px});
        if (layers.empty())
            composed_.clear();
        else
            compose(layers, view);
        return filler_.fill(composed_.colour(), composed_.depth_m());
    }

  private:
    void compose(const std::vector<DrawnLayer>& layers, const VirtualView& view) {
        for (std::size_t i = 0; i < layers.size(); ++i) warps_[i].warp(*layers[i].surface, view);
        FullscreenPass& pass = compose_[layers.size() - 1];
        Program& program = pass.use();
        program.set("softness", same_surface_share);
        for (std::size_t i = 0; i < layers.size(); ++i) {
            const ReliefWarp& relief = warps_[i];
            const DepthView& camera = layers[i].surface->camera();
            const Pose rig_from_target =
                camera.world_from_camera.inverse() * view.world_from_camera;
            const auto set = [&](const char* name, const auto& value) {
                program.set(name, i, value);
            };
            program.input("warped_colour", i, relief.colour());
            program.input("warped_m", i, relief.depth_m());
            set("ray",
                Eigen::Matrix3f((rig_from_target.linear() * view.K.inverse()).cast<float>()));
            set("eye", Eigen::Vector3f(rig_from_target.translation().cast<float>()));
            set("pinhole", Eigen::Vector4f(Eigen::Vector4d(camera.K(0, 0), camera.K(1, 1),
                                                           camera.K(0, 2), camera.K(1, 2))
                                               .cast<float>()));
            set("plane", Eigen::Vector3f(Eigen::Vector3d(relief.plane_m(), relief.margin_px().width,
                                                         relief.margin_px().height)
                                             .cast<float>()));
            set("spread", depth_spread(camera));
            set("presence", layers[i].presence);
        }
        pass.draw(composed_.target());
    }

    std::vector<ReliefWarp> warps_;
    std::vector<FullscreenPass> compose_;  ///< one for every number of rigs
    DepthPicture composed_;
    HoleFiller filler_;
};

/// The inverse form (Policarpo, Oliveira, Comba, "Real-time relief mapping on arbitrary polygonal
/// surfaces", 2005): each pixel's line of sight is searched for where it meets the rigs' reliefs.
class SearchRenderer final : public ViewRenderer {
  public:
    explicit SearchRenderer(const ShaderLibrary& library)
        : search_(library, "relief_search.frag"),
          blend_(library, "mesh_blend.frag", same_surface_share),
          blender_(library) {}

    const Texture& render(const Instant& instant, const VirtualView& view,
                          const RenderLevel& level) override {
        blender_.layers().draw(
            layers_of(instant, view, level.rigs), view,
            [&](const RigSurface& surface, double near_m, const Framebuffer& depth_only) {
                Program& program = search_.use();
                DepthView map = surface.camera();
                map.K = surface.K_depth();
                program.input("depth_map", surface.depth());
                program.set("pixel_from_target",
                            Eigen::Matrix4f(pixel_from_target_pixel(map, view).cast<float>()));
                const double typical_m = surface.median_depth_m();
                program.set("range_m",
                            Eigen::Vector2f(static_cast<float>(nearest_share * typical_m),
                                            static_cast<float>(farthest_share * typical_m)));
                program.set("near_m", static_cast<float>(near_m));
                program.set("edge_ratio", depth_edge_ratio);
                search_.draw_depth(depth_only);
            });
        return blender_.blend(view, blend_);
    }

  private:
    FullscreenPass search_;
    LayerPass blend_;
    LayerBlender blender_;
};

}  // namespace

SynthesiserEntry relief_synthesiser_entry() {
    return {
        .name = "relief",
        .summary = "pictures with depth, pre-warped in two 1-D passes, then mapped as textures",
        .make_preparer =
            [](const ShaderLibrary& library) { return std::make_unique<PlainPreparer>(library); },
        .make_renderer = {},
        .tells_origins = false,
        .options = {{.name = "form",
                     .summary = "prewarp, as in 2000, or search along each line of sight, as "
                                "in 2005",
                     .by_default = "prewarp",
                     .words = {"prewarp", "search"}}},
        .make_renderer_with = [](const ShaderLibrary& library, const SynthesiserChoices& choices)
            -> std::unique_ptr<ViewRenderer> {
            if (choices.word("form") == "search") return std::make_unique<SearchRenderer>(library);
            return std::make_unique<PrewarpRenderer>(library);
        }};
}

}  // namespace vantage
