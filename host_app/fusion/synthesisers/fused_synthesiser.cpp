#include <memory>
#include <vector>

#include "common/gl/fullscreen_pass.h"
#include "host_app/fusion/depth_closer.h"
#include "host_app/fusion/depth_picture.h"
#include "host_app/fusion/depth_steadier.h"
#include "host_app/fusion/edge_trust.h"
#include "host_app/fusion/gpu_view.h"
#include "host_app/fusion/hole_filler.h"
#include "host_app/fusion/rig_layers.h"
#include "host_app/fusion/rig_presence.h"
#include "host_app/fusion/synthesiser.h"
#include "host_app/fusion/view_ranking.h"

namespace vantage {
namespace {

/// Surfaces of two rigs that are nearer to each other than this share of their depth are one.
constexpr float softness = 0.005f;
/// Depths that differ by more than this ratio lie on two surfaces.
constexpr float edge_ratio = 1.03f;

/// The best that is done live: the rigs' depth maps are closed, the surfaces that they agree on are
/// found for every pixel, each rig that sees a surface gives its colour to it, and close to depth
/// edges the rigs' colours decide which surface it is.
class FusedSynthesiser final : public Synthesiser {
  public:
    explicit FusedSynthesiser(const ShaderLibrary& library)

        : steadier_(library),
          closer_(library),
          edge_trust_(library),
          layers_(library),
          filler_(library) {
        for (std::size_t layers = 1; layers <= RigLayers::max_layers; ++layers) {
            const ShaderDefines defines{{"LAYERS", std::to_string(layers)}};
            depth_pass_.emplace_back(library, "fused_depth.frag", defines);
            colour_pass_.emplace_back(library, "fused_colour.frag", defines);
        }
    }

    void set_views(std::span<const DepthView> views) override {
        for (GpuView* view : upload_with_fades(views, views_)) {
            steadier_.steady(*view);
            closer_.close(view->steady_depth(), view->surface_target());
            edge_trust_.judge(*view);
            layers_.rasteriser().build_triangles(*view);
        }
    }

    const Texture& render(const VirtualView& view) override {
        layers_.draw(most_useful(views_, view, RigLayers::max_layers), view);
        const cv::Size size(view.width_px, view.height_px);
        fused_depth_.resize(size);
        fused_.resize(size);
        if (layers_.used().empty())
            fused_.clear();
        else
            fuse();
        return filler_.fill(fused_.colour(), fused_.depth_m());
    }

  private:
    void fuse() {
        const std::size_t variant = layers_.used().size() - 1;
        Program& depth = depth_pass_[variant].use();
        layers_.bind(depth);
        depth.set("softness", softness);
        depth_pass_[variant].draw(fused_depth_.target());

        Program& colour = colour_pass_[variant].use();
        layers_.bind(colour);
        colour.set("fused_depth", layers_.first_free_unit());
        colour.set("softness", softness);
        colour.set("edge_ratio", edge_ratio);
        fused_depth_.texture().bind(layers_.first_free_unit());
        colour_pass_[variant].draw(fused_.target());
    }

    std::vector<std::unique_ptr<GpuView>> views_;
    DepthSteadier steadier_;
    DepthCloser closer_;
    EdgeTrust edge_trust_;
    RigLayers layers_;
    HoleFiller filler_;
    std::vector<FullscreenPass> depth_pass_, colour_pass_;  ///< one for every number of layers
    DrawnTexture fused_depth_{TextureFormat::r32f};
    DepthPicture fused_;
};

}  // namespace

SynthesiserEntry fused_synthesiser_entry() {
    return {
        "fused",
        "per-pixel visibility in all rigs, soft depth edges, colours trusted by their place",
        [](const ShaderLibrary& library) { return std::make_unique<FusedSynthesiser>(library); }};
}

}  // namespace vantage
