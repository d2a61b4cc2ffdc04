#include <memory>
#include <optional>
#include <vector>

#include "common/gl/two_stage_pass.h"
#include "host_app/baked/baked_painter.h"
#include "host_app/fused/foreground_layers.h"
#include "host_app/fused/fused_colour.h"
#include "host_app/fused/impulse_filter.h"
#include "host_app/fused/staged_preparer.h"
#include "host_app/synthesis/layer_blender.h"
#include "host_app/synthesis/layer_ranking.h"
#include "host_app/synthesis/synthesiser.h"

namespace vantage {
namespace {

/// The product's synthesiser. It fuses the rigs' refined surfaces for every pixel by a consistency
/// check, blends the colours of the rigs that see the surface, and lets the rigs' colours decide
/// between two surfaces beside depth edges.
class FusedRenderer final : public ViewRenderer {
  public:
    explicit FusedRenderer(const ShaderLibrary& library)
        : colour_(library),
          blender_(library),
          impulses_(library),
          performers_(library),
          baked_(library),
          filler_(library) {
        for (std::size_t layers = 1; layers <= RigLayers::max_layers; ++layers)
            depth_pass_.emplace_back(library, "fused_depth.frag",
                                     ShaderDefines{{"LAYERS", std::to_string(layers)}});
    }

    const Texture& render(const Instant& instant, const VirtualView& view,
                          const RenderLevel& level) override {
        if (const auto* baked = dynamic_cast<const BakedInstant*>(instant.extra.get()))
            return render_baked(instant, *baked, view, level);
        RigLayers& layers = blender_.layers();
        const std::vector<const InstantRig*> rigs = ranked_rigs(instant, view, level.rigs);
        layers.draw(layers_of(rigs), view, finely_drawn(instant, level));
        fused_depth_.resize({view.width_px, view.height_px});
        const Texture* kinds = nullptr;
        if (!layers.used().empty()) {
            find_depth();
            if (!level.is_plain) kinds = &colour_.sort(fused_depth_.texture());
        }
        const Texture& set = blender_.blend(
            view,
            [&](const DepthPicture& into, bool notes_origins) {
                if (level.is_plain)
                    colour_.draw_plainly(layers, fused_depth_.texture(), into, notes_origins);
                else
                    colour_.draw(layers, fused_depth_.texture(), into, notes_origins);
            },
            {}, kinds);
        origins_.reset();
        depth_m_ = nullptr;
        if (blender_.origins()) origins_ = *blender_.origins();
        if (layers.used().empty()) return set;
        const std::vector<DrawnLayer> performers = layers_of(rigs, &InstantRig::boundary);
        const DepthPicture& picture =
            performers_.show(set, fused_depth_.texture(), origins_ ? origins_->shares : nullptr,
                             performers, view, level.is_plain);
        if (origins_) origins_->shares = picture.shares();
        depth_m_ = &picture.depth_m();
        return impulses_.filter(picture.colour(), *depth_m_);
    }

    bool note_origins(bool noted) override {
        blender_.note_origins(noted);
        notes_origins_ = noted;
        return true;
    }
    const PixelOrigins* origins() const override { return origins_ ? &*origins_ : nullptr; }
    const Texture* depth_m() const override { return depth_m_; }

  private:
    /// Renders an instant whose background is baked.
    const Texture& render_baked(const Instant& instant, const BakedInstant& baked,
                                const VirtualView& view, const RenderLevel& level) {
        const std::vector<const InstantRig*> rigs = ranked_rigs(instant, view, level.rigs);
        origins_.reset();
        std::vector<std::string> names;
        if (notes_origins_)
            for (const InstantRig* rig : ranked_rigs(instant, view, PixelOrigins::max_rigs))
                names.push_back(rig->camera().name);
        const DepthPicture& background =
            baked_.draw(baked, view, near_plane_m(layers_of(rigs)), names, level.is_plain,
                        remembered_alpha / 255.0f);
        const Texture& filled = filler_.fill(background.colour(), background.depth_m());
        if (notes_origins_) origins_ = {background.shares(), names};
        depth_m_ = &background.depth_m();
        if (rigs.empty()) return filled;
        const std::vector<DrawnLayer> performers = layers_of(rigs, &InstantRig::boundary);
        const DepthPicture& picture = performers_.show(
            filled, background.depth_m(), background.shares(), performers, view, level.is_plain);
        if (origins_) origins_->shares = picture.shares();
        depth_m_ = &picture.depth_m();
        return impulses_.filter(picture.colour(), *depth_m_);
    }

    void find_depth() {
        const RigLayers& layers = blender_.layers();
        depth_pass_[layers.used().size() - 1].draw(fused_depth_.target(), [&](Program& program) {
            layers.bind(program);
            program.set("softness", same_surface_share);
        });
    }

    FusedColour colour_;
    LayerBlender blender_;
    ImpulseFilter impulses_;
    ForegroundLayers performers_;
    BakedPainter baked_;
    HoleFiller filler_;
    bool notes_origins_ = false;
    std::optional<PixelOrigins> origins_;
    const Texture* depth_m_ = nullptr;
    std::vector<TwoStagePass> depth_pass_;  ///< one for every number of layers
    DrawnTexture fused_depth_{TextureFormat::r32f, Filter::nearest, false, DrawnWith::depth_test};
};

}  // namespace

SynthesiserEntry fused_synthesiser_entry() {
    return {
        "fused",
        "per-pixel visibility in all rigs, soft depth edges, background apart from the foreground",
        [](const ShaderLibrary& library) { return std::make_unique<StagedPreparer>(library); },
        [](const ShaderLibrary& library) { return std::make_unique<FusedRenderer>(library); }};
}

}  // namespace vantage
