#include <memory>

#include "host_app/pipeline/instant_preparer.h"
#include "host_app/synthesis/layer_blender.h"
#include "host_app/synthesis/rig_layers.h"
#include "host_app/synthesis/synthesiser.h"

namespace vantage {
namespace {

/// The system of Edling and Franke (2006): every rig's depth map as a quad grid displaced by depth,
/// stretched quads cut by an edge filter, and the rigs' meshes blended by viewing angle where they
/// show the same surface.
class MeshRenderer final : public ViewRenderer {
  public:
    explicit MeshRenderer(const ShaderLibrary& library)
        : blend_(library, "mesh_blend.frag", same_surface_share), blender_(library) {}

    const Texture& render(const Instant& instant, const VirtualView& view,
                          const RenderLevel& level) override {
        blender_.layers().draw(layers_of(instant, view, level.rigs), view,
                               finely_drawn(instant, level));
        return blender_.blend(view, blend_);
    }

    bool note_origins(bool noted) override {
        blender_.note_origins(noted);
        return true;
    }
    const PixelOrigins* origins() const override { return blender_.origins(); }
    const Texture* depth_m() const override { return &blender_.depth_m(); }

  private:
    LayerPass blend_;
    LayerBlender blender_;
};

}  // namespace

SynthesiserEntry mesh_synthesiser_entry() {
    return {"mesh", "quad grids displaced by depth, cut at edges, blended by viewing angle",
            [](const ShaderLibrary& library) { return std::make_unique<PlainPreparer>(library); },
            [](const ShaderLibrary& library) { return std::make_unique<MeshRenderer>(library); }};
}

}  // namespace vantage
