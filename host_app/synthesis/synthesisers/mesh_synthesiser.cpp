#include <memory>
#include <vector>

#include "host_app/synthesis/gpu_view.h"
#include "host_app/synthesis/layer_blender.h"
#include "host_app/synthesis/synthesiser.h"
#include "host_app/synthesis/view_ranking.h"

namespace vantage {
namespace {

/// Surfaces of two rigs that are nearer to each other than this share of their depth are one.
constexpr float softness = 0.005f;

/// The system of Edling and Franke (2006): every rig's depth map as a quad grid displaced by depth,
/// stretched quads cut by an edge filter, and the rigs' meshes blended by viewing angle where they
/// show the same surface.
class MeshSynthesiser final : public Synthesiser {
  public:
    explicit MeshSynthesiser(const ShaderLibrary& library)
        : blend_(library, "mesh_blend.frag", softness), blender_(library) {}

    void set_views(std::span<const DepthView> views) override {
        upload_views(views, views_);
        for (const auto& view : views_) blender_.layers().rasteriser().build_triangles(*view);
    }

    const Texture& render(const VirtualView& view) override {
        blender_.layers().draw(most_useful(views_, view, RigLayers::max_layers), view);
        return blender_.blend(view, blend_);
    }

    bool note_origins(bool noted) override {
        blender_.note_origins(noted);
        return true;
    }
    const PixelOrigins* origins() const override { return blender_.origins(); }

  private:
    std::vector<std::unique_ptr<GpuView>> views_;
    LayerPass blend_;
    LayerBlender blender_;
};

}  // namespace

SynthesiserEntry mesh_synthesiser_entry() {
    return {
        "mesh", "quad grids displaced by depth, cut at edges, blended by viewing angle",
        [](const ShaderLibrary& library) { return std::make_unique<MeshSynthesiser>(library); }};
}

}  // namespace vantage
