#include <algorithm>
#include <memory>
#include <vector>

#include "host_app/gallery/layered_preparer.h"
#include "host_app/synthesis/layer_blender.h"
#include "host_app/synthesis/synthesiser.h"
#include "host_app/views/view_ranking.h"

namespace vantage {
namespace {

/// Relative depth difference up to which the surfaces of two rigs count as the same surface.
constexpr float softness = 0.01f;
/// As in the paper, the two nearest cameras are blended.
constexpr std::size_t blended_views = 2;

/// Layered view interpolation after Zitnick et al. (2004). Their cameras form a row, where two
/// neighbours see everything; here the next two rigs fill what the two nearest ones do not see.
class LayeredRenderer final : public ViewRenderer {
  public:
    explicit LayeredRenderer(const ShaderLibrary& library)
        : blend_(library, "layered_blend.frag", softness, {}, 2),
          under_(library, "layered_under.frag"),
          blender_(library),
          next_layers_(library) {}

    const Texture& render(const Instant& instant, const VirtualView& view,
                          const RenderLevel& level) override {
        std::vector<const InstantRig*> all;
        for (const InstantRig& rig : instant.rigs) all.push_back(&rig);
        const auto useful = most_useful(all, view, std::min(level.rigs, 2 * blended_views));
        const auto layers = [&](std::size_t first) {
            std::vector<DrawnLayer> used;
            for (std::size_t i = first; i < std::min(first + blended_views, useful.size()); ++i) {
                used.push_back({useful[i]->surface.get(), useful[i]->presence});
                used.push_back({useful[i]->boundary.get(), useful[i]->presence});
            }
            return used;
        };
        blender_.layers().draw(layers(0), view);
        next_layers_.draw(layers(blended_views), view);
        return blender_.blend(
            view,
            [&](const DepthPicture& into, bool noted) {
                blend_.use(blender_.layers(), noted).draw(into.target());
            },
            [&](const DepthPicture& nearest) -> const DepthPicture& {
                return next_layers_.used().empty() ? nearest : with_next(nearest, view);
            });
    }

    /// Records the shares of the two nearest rigs only.
    bool note_origins(bool noted) override {
        blender_.note_origins(noted);
        return true;
    }
    const PixelOrigins* origins() const override { return blender_.origins(); }

  private:
    const DepthPicture& with_next(const DepthPicture& nearest, const VirtualView& view) {
        next_.resize({view.width_px, view.height_px});
        both_.resize({view.width_px, view.height_px});
        blend_.use(next_layers_, false).draw(next_.target());
        Program& program = under_.use();
        program.input("colour", nearest.colour());
        program.input("depth_m", nearest.depth_m());
        program.input("next_colour", next_.colour());
        program.input("next_depth_m", next_.depth_m());
        under_.draw(both_.target());
        return both_;
    }

    LayerPass blend_;
    FullscreenPass under_;
    LayerBlender blender_;
    RigLayers next_layers_;
    DepthPicture next_, both_;
};

}  // namespace

SynthesiserEntry layered_synthesiser_entry() {
    return {
        "layered", "main layers with matted boundary layers, the two nearest rigs blended",
        [](const ShaderLibrary& library) { return std::make_unique<LayeredPreparer>(library); },
        [](const ShaderLibrary& library) { return std::make_unique<LayeredRenderer>(library); }};
}

}  // namespace vantage
