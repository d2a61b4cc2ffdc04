#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "common/gl/two_stage_pass.h"
#include "host_app/baked/baked_painter.h"
#include "host_app/fused/foreground_layers.h"
#include "host_app/fused/fused_colour.h"
#include "host_app/fused/fused_renderer.h"
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
          baked_(library) {
        for (std::size_t layers = 1; layers <= RigLayers::max_layers; ++layers)
            depth_pass_.emplace_back(library, "fused_depth.frag",
                                     ShaderDefines{{"LAYERS", std::to_string(layers)}});
    }

    const Texture& render(const Instant& instant, const VirtualView& view,
                          const RenderLevel& level) override {
        const std::vector<const InstantRig*> rigs = ranked_rigs(instant, view, level.rigs);
        const auto* extra = dynamic_cast<const BakedExtra*>(instant.extra.get());
        // A driver compiles a shader when it is first used: not when the first probe is there.
        if (level.is_plain && !std::exchange(is_baked_warm_, true) && !rigs.empty())
            (void)render_baked({}, rigs, view, level);
        if (level.is_plain && extra && !rigs.empty())
            return render_baked(*extra->background, rigs, view, level);
        RigLayers& layers = blender_.layers();
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
        return with_performers(set, fused_depth_.texture(), rigs, view, level, false);
    }

    bool note_origins(bool noted) override {
        blender_.note_origins(noted);
        return true;
    }
    const PixelOrigins* origins() const override { return origins_ ? &*origins_ : nullptr; }
    const Texture* depth_m() const override { return depth_m_; }

  private:
    const Texture& render_baked(const BakedBackground& background,
                                std::span<const InstantRig* const> rigs, const VirtualView& view,
                                const RenderLevel& level) {
        RigLayers& layers = blender_.layers();
        layers.draw(layers_of(rigs), view, [](const auto&...) {});
        baked_.draw(background, view);
        picture_.resize({view.width_px, view.height_px}, blender_.notes_origins());
        colour_.draw_on_baked(layers, baked_.depth_m(), baked_.colour(), picture_,
                              blender_.notes_origins());
        origins_.reset();
        if (blender_.notes_origins()) {
            origins_ = {picture_.shares(), {}};
            for (const DrawnLayer& layer : layers.used())
                origins_->rigs.push_back(layer.surface->camera().name);
        }
        return with_performers(picture_.colour(), picture_.depth_m(), rigs, view, level, true);
    }

    /// Draws the rigs' foregrounds over a picture of the background and removes impulses, of which
    /// a baked background has none.
    const Texture& with_performers(const Texture& background, const Texture& background_m,
                                   std::span<const InstantRig* const> rigs, const VirtualView& view,
                                   const RenderLevel& level, bool is_baked) {
        if (!rigs.front()->boundary) {
            depth_m_ = &background_m;
            return is_baked ? background : impulses_.filter(background, background_m);
        }
        const std::vector<DrawnLayer> performers = layers_of(rigs, &InstantRig::boundary);
        const DepthPicture& picture =
            performers_.show(background, background_m, origins_ ? origins_->shares : nullptr,
                             performers, view, level.is_plain);
        if (origins_) origins_->shares = picture.shares();
        depth_m_ = &picture.depth_m();
        if (is_baked) return picture.colour();
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
    bool is_baked_warm_ = false;
    DepthPicture picture_;  ///< of the background, where it is baked
    std::optional<PixelOrigins> origins_;
    const Texture* depth_m_ = nullptr;
    std::vector<TwoStagePass> depth_pass_;  ///< one for every number of layers
    DrawnTexture fused_depth_{TextureFormat::r32f, Filter::nearest, false, DrawnWith::depth_test};
};

}  // namespace

std::unique_ptr<ViewRenderer> make_fused_renderer(const ShaderLibrary& library) {
    return std::make_unique<FusedRenderer>(library);
}

SynthesiserEntry fused_synthesiser_entry() {
    return {
        "fused",
        "per-pixel visibility in all rigs, soft depth edges, background apart from the foreground",
        [](const ShaderLibrary& library) { return std::make_unique<StagedPreparer>(library); },
        [](const ShaderLibrary& library) { return make_fused_renderer(library); }};
}

}  // namespace vantage
