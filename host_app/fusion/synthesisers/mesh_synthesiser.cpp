#include <memory>
#include <vector>

#include "common/gl/fullscreen_pass.h"
#include "host_app/fusion/depth_picture.h"
#include "host_app/fusion/gpu_view.h"
#include "host_app/fusion/hole_filler.h"
#include "host_app/fusion/rig_layers.h"
#include "host_app/fusion/synthesiser.h"
#include "host_app/fusion/view_ranking.h"

namespace vantage {
namespace {

/// Surfaces of two rigs that are nearer to each other than this share of their depth are one.
constexpr float softness = 0.005f;

/// The system of Edling and Franke (2006): every rig's depth map as a quad grid displaced by depth,
/// stretched quads cut by an edge filter, and the rigs' meshes blended by viewing angle where they
/// show the same surface.
class MeshSynthesiser final : public Synthesiser {
  public:
    explicit MeshSynthesiser(const ShaderLibrary& library) : layers_(library), filler_(library) {
        for (std::size_t layers = 1; layers <= RigLayers::max_layers; ++layers)
            blend_.emplace_back(library, "mesh_blend.frag",
                                ShaderDefines{{"LAYERS", std::to_string(layers)}});
    }

    void set_views(std::span<const DepthView> views) override {
        upload_views(views, views_);
        for (const auto& view : views_) layers_.rasteriser().build_triangles(*view);
    }

    const Texture& render(const VirtualView& view) override {
        layers_.draw(most_useful(views_, view, RigLayers::max_layers), view);
        blended_.resize({view.width_px, view.height_px});
        if (layers_.used().empty()) {
            blended_.clear();
        } else {
            FullscreenPass& pass = blend_[layers_.used().size() - 1];
            Program& program = pass.use();
            layers_.bind(program);
            program.set("softness", softness);
            pass.draw(blended_.target());
        }
        return filler_.fill(blended_.colour(), blended_.depth_m());
    }

  private:
    std::vector<std::unique_ptr<GpuView>> views_;
    RigLayers layers_;
    HoleFiller filler_;
    std::vector<FullscreenPass> blend_;  ///< one for every number of layers
    DepthPicture blended_;
};

}  // namespace

SynthesiserEntry mesh_synthesiser_entry() {
    return {
        "mesh", "quad grids displaced by depth, cut at edges, blended by viewing angle",
        [](const ShaderLibrary& library) { return std::make_unique<MeshSynthesiser>(library); }};
}

}  // namespace vantage
