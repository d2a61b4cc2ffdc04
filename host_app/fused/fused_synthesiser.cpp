#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "host_app/baked/background_probe.h"
#include "host_app/baked/baked_painter.h"
#include "host_app/fused/foreground_layers.h"
#include "host_app/fused/fused_colour.h"
#include "host_app/fused/impulse_filter.h"
#include "host_app/fused/own_picture.h"
#include "host_app/fused/staged_preparer.h"
#include "host_app/synthesis/layer_blender.h"
#include "host_app/synthesis/rig_layers.h"
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
          depth_(library),
          own_(library) {}

    const Texture& render(const Instant& instant, const VirtualView& view,
                          const RenderLevel& level) override {
        const std::vector<const InstantRig*> rigs = ranked_rigs(instant, view, level.rigs);
        const auto* extra = dynamic_cast<const BakedExtra*>(instant.extra.get());
        const bool has_foreground = !rigs.empty() && rigs.front()->boundary;
        // A driver compiles a shader when it is first used: not when the first probe is there.
        if (level.is_plain && has_foreground && !std::exchange(is_baked_warm_, true))
            (void)render_baked({}, rigs, view);
        if (level.is_plain && has_foreground && extra)
            return render_baked(extra->background, rigs, view);
        RigLayers& layers = blender_.layers();
        layers.draw(layers_of(rigs), view, finely_drawn(instant, level));
        const Texture *fused_depth = nullptr, *kinds = nullptr;
        if (!layers.used().empty()) {
            fused_depth = &depth_.find(layers, {view.width_px, view.height_px});
            if (!level.is_plain) kinds = &colour_.sort(*fused_depth);
        }
        const Texture& set = blender_.blend(
            view,
            [&](const DepthPicture& into, bool notes_origins) {
                if (level.is_plain)
                    colour_.draw_plainly(layers, *fused_depth, into, notes_origins);
                else
                    colour_.draw(layers, *fused_depth, into, notes_origins);
            },
            {}, kinds);
        origins_.reset();
        depth_m_ = nullptr;
        if (blender_.origins()) origins_ = *blender_.origins();
        if (layers.used().empty()) return set;
        return with_performers(set, *fused_depth, rigs, view, level);
    }

    bool note_origins(bool noted) override {
        blender_.note_origins(noted);
        return true;
    }
    const PixelOrigins* origins() const override { return origins_ ? &*origins_ : nullptr; }
    const Texture* depth_m() const override { return depth_m_; }

  private:
    /// Draws a view of a baked background with the rigs' colours and foregrounds of this instant.
    const Texture& render_baked(const BakedBackground& background,
                                std::span<const InstantRig* const> rigs, const VirtualView& view) {
        const bool notes_origins = blender_.notes_origins();
        RigLayers& layers = blender_.layers();
        layers.begin(layers_of(rigs), view);
        std::vector<std::string> names;
        for (const InstantRig* rig : rigs) names.push_back(rig->camera().name);
        const DepthPicture& baked = baked_.draw(background, view, names);
        const DepthPicture& foreground = performers_.show_alone(
            baked.depth_m(), notes_origins, layers_of(rigs, &InstantRig::boundary), view);
        picture_.resize({view.width_px, view.height_px}, notes_origins);
        colour_.draw_on_baked(layers, baked, foreground, picture_, notes_origins);
        origins_.reset();
        if (notes_origins) origins_ = origins_of(picture_, layers);
        depth_m_ = &picture_.depth_m();
        return finished(picture_.colour(), rigs, view);
    }

    /// Draws the rigs' foregrounds over a picture of the background and removes impulses.
    const Texture& with_performers(const Texture& background, const Texture& background_m,
                                   std::span<const InstantRig* const> rigs, const VirtualView& view,
                                   const RenderLevel& level) {
        if (!rigs.front()->boundary) {
            depth_m_ = &background_m;
            return finished(background, rigs, view);
        }
        const DepthPicture& picture =
            performers_.show(background, background_m, origins_ ? origins_->shares : nullptr,
                             layers_of(rigs, &InstantRig::boundary), view, level.is_plain);
        if (origins_) origins_->shares = picture.shares();
        depth_m_ = &picture.depth_m();
        return finished(picture.colour(), rigs, view);
    }

    /// Removes impulses from a picture and lays that of a near rig over it.
    const Texture& finished(const Texture& picture, std::span<const InstantRig* const> rigs,
                            const VirtualView& view) {
        const Texture& filtered = impulses_.filter(picture, *depth_m_);
        const std::optional<NearRig> near = near_rig(rigs, view);
        if (!near) return filtered;
        if (origins_ && origins_->shares)
            origins_->shares =
                &own_.lay_over_shares(*origins_->shares, *depth_m_, *near, rigs, view);
        return own_.lay_over(filtered, *depth_m_, *near, rigs, view);
    }

    FusedColour colour_;
    LayerBlender blender_;
    ImpulseFilter impulses_;
    ForegroundLayers performers_;
    BakedPainter baked_;
    FusedDepth depth_;
    OwnPicture own_;
    bool is_baked_warm_ = false;
    DepthPicture picture_;  ///< of the background, where it is baked
    std::optional<PixelOrigins> origins_;
    const Texture* depth_m_ = nullptr;
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
