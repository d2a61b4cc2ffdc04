#include <memory>
#include <vector>

#include "host_app/instants/layered_preparer.h"
#include "host_app/instants/view_ranking.h"
#include "host_app/synthesis/layer_blender.h"
#include "host_app/synthesis/synthesiser.h"

namespace vantage {
namespace {

/// Surfaces of two rigs that are nearer to each other than this share of their depth are one.
constexpr float softness = 0.01f;
/// As in the paper, the two nearest cameras are blended.
constexpr std::size_t blended_views = 2;

/// Layered view interpolation after Zitnick et al. (2004).
class LayeredRenderer final : public ViewRenderer {
  public:
    explicit LayeredRenderer(const ShaderLibrary& library)
        : blend_(library, "layered_blend.frag", softness, {}, 2), blender_(library) {}

    const Texture& render(const Instant& instant, const VirtualView& view,
                          const RenderLevel& /*level*/) override {
        std::vector<const InstantRig*> all;
        for (const InstantRig& rig : instant.rigs) all.push_back(&rig);
        std::vector<DrawnLayer> used;
        for (const InstantRig* rig : most_useful(all, view, blended_views)) {
            used.push_back({rig->surface.get(), rig->presence});
            used.push_back({rig->boundary.get(), rig->presence});
        }
        blender_.layers().draw(used, view);
        return blender_.blend(view, blend_);
    }

    bool note_origins(bool noted) override {
        blender_.note_origins(noted);
        return true;
    }
    const PixelOrigins* origins() const override { return blender_.origins(); }

  private:
    LayerPass blend_;
    LayerBlender blender_;
};

}  // namespace

SynthesiserEntry layered_synthesiser_entry() {
    return {
        "layered", "main layers with matted boundary layers, the two nearest rigs blended",
        [](const ShaderLibrary& library) { return std::make_unique<LayeredPreparer>(library); },
        [](const ShaderLibrary& library) { return std::make_unique<LayeredRenderer>(library); }};
}

}  // namespace vantage
