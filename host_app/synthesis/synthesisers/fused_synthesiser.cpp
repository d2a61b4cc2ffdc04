#include <algorithm>
#include <memory>
#include <vector>

#include "common/gl/fullscreen_pass.h"
#include "host_app/synthesis/background_plate.h"
#include "host_app/synthesis/colour_steadier.h"
#include "host_app/synthesis/depth_closer.h"
#include "host_app/synthesis/depth_steadier.h"
#include "host_app/synthesis/edge_trust.h"
#include "host_app/synthesis/fused_colour.h"
#include "host_app/synthesis/gpu_view.h"
#include "host_app/synthesis/layer_blender.h"
#include "host_app/synthesis/rig_consensus.h"
#include "host_app/synthesis/rig_presence.h"
#include "host_app/synthesis/synthesiser.h"
#include "host_app/synthesis/view_ranking.h"

namespace vantage {
namespace {

/// Surfaces of two rigs that are nearer to each other than this share of their depth are one.
constexpr float softness = 0.005f;
/// Where there are more rigs than a picture takes, the surfaces of so many are drawn by every
/// pixel: the others mostly fill what these leave, and a quarter of the quads does for that.
constexpr std::size_t finely_drawn = 2;

/// The best that is done live: the rigs' depth maps are bettered by each other and closed, the
/// surfaces that they agree on are found for every pixel, each rig that sees a surface gives its
/// colour to it, and close to depth edges the rigs' colours decide which surface it is.
class FusedSynthesiser final : public Synthesiser {
  public:
    explicit FusedSynthesiser(const ShaderLibrary& library)
        : colour_steadier_(library),
          steadier_(library),
          closer_(library),
          consensus_(library),
          edge_trust_(library),
          plates_(library),
          colour_(library),
          blender_(library) {
        for (std::size_t layers = 1; layers <= RigLayers::max_layers; ++layers)
            depth_pass_.emplace_back(library, "fused_depth.frag",
                                     ShaderDefines{{"LAYERS", std::to_string(layers)}});
    }

    void set_views(std::span<const DepthView> views) override {
        for (GpuView* view : upload_with_fades(views, views_)) {
            colour_steadier_.steady(*view);
            steadier_.steady(*view);
            plates_.learn(*view);
        }
    }

    void forget() override {
        for (const auto& view : views_) view->plate().forget();
    }

    const Texture& render(const VirtualView& view) override {
        RigLayers& layers = blender_.layers();
        const std::vector<const GpuView*> used = most_useful(views_, view, RigLayers::max_layers);
        for (const auto& one : views_)
            if (!one->is_prepared() && std::find(used.begin(), used.end(), one.get()) != used.end())
                prepare(*one);
        layers.draw(used, view,
                    views_.size() > RigLayers::max_layers ? finely_drawn : RigLayers::max_layers);
        fused_depth_.resize({view.width_px, view.height_px});
        const Texture* kinds = nullptr;
        if (!layers.used().empty()) {
            find_depth();
            kinds = &colour_.sort(fused_depth_.texture());
        }
        return blender_.blend(
            view,
            [&](const DepthPicture& into, bool notes_origins) {
                colour_.draw(layers, fused_depth_.texture(), into, notes_origins);
            },
            [&](const DepthPicture& blended) -> const DepthPicture& {
                return plates_.show(blended, layers, view);
            },
            kinds);
    }

    bool note_origins(bool noted) override {
        blender_.note_origins(noted);
        return true;
    }
    const PixelOrigins* origins() const override { return blender_.origins(); }

  private:
    /// What only those rigs need that take part in a picture, once an instant.
    void prepare(GpuView& view) {
        // Asked for before anything is bound: making a texture binds it.
        const Framebuffer& surface = view.surface_target();
        closer_.close(consensus_.better(view, views_), view.steady_depth(), view.colour(), surface);
        steadier_.settle(view);
        edge_trust_.judge(view);
        for (const QuadGrid grid : {QuadGrid::fine, QuadGrid::coarse})
            blender_.layers().rasteriser().build_triangles(view, grid);
        blender_.layers().rasteriser().build_rims(view);
        view.set_prepared();
    }

    void find_depth() {
        FullscreenPass& pass = depth_pass_[blender_.layers().used().size() - 1];
        Program& program = pass.use();
        blender_.layers().bind(program);
        program.set("softness", softness);
        pass.draw(fused_depth_.target());
    }

    std::vector<std::unique_ptr<GpuView>> views_;
    ColourSteadier colour_steadier_;
    DepthSteadier steadier_;
    DepthCloser closer_;
    RigConsensus consensus_;
    EdgeTrust edge_trust_;
    BackgroundPlates plates_;
    FusedColour colour_;
    LayerBlender blender_;
    std::vector<FullscreenPass> depth_pass_;  ///< one for every number of layers
    DrawnTexture fused_depth_{TextureFormat::r32f};
};

}  // namespace

SynthesiserEntry fused_synthesiser_entry() {
    return {
        "fused",
        "per-pixel visibility in all rigs, soft depth edges, colours trusted by their place",
        [](const ShaderLibrary& library) { return std::make_unique<FusedSynthesiser>(library); }};
}

}  // namespace vantage
