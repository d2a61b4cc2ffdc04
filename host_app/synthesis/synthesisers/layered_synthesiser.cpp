#include <algorithm>
#include <memory>
#include <vector>

#include "host_app/synthesis/gpu_view.h"
#include "host_app/synthesis/layer_blender.h"
#include "host_app/synthesis/layer_splitter.h"
#include "host_app/synthesis/synthesiser.h"
#include "host_app/synthesis/view_ranking.h"

namespace vantage {
namespace {

/// Surfaces of two rigs that are nearer to each other than this share of their depth are one.
constexpr float softness = 0.01f;
/// As in the paper, the two nearest cameras are blended.
constexpr std::size_t blended_views = 2;

/// Layered view interpolation after Zitnick et al. (2004).
class LayeredSynthesiser final : public Synthesiser {
  public:
    explicit LayeredSynthesiser(const ShaderLibrary& library)
        : splitter_(library),
          blend_(library, "layered_blend.frag", softness, {}, 2),
          blender_(library) {}

    void set_views(std::span<const DepthView> views) override {
        upload_views(views, mains_);
        upload_views(views, boundaries_);
        for (std::size_t i = 0; i < mains_.size(); ++i) {
            splitter_.split(*mains_[i], *mains_[i], *boundaries_[i]);
            blender_.layers().rasteriser().build_triangles(*mains_[i]);
            blender_.layers().rasteriser().build_triangles(*boundaries_[i]);
        }
    }

    const Texture& render(const VirtualView& view) override {
        std::vector<const GpuView*> used;
        for (const GpuView* main : most_useful(mains_, view, blended_views)) {
            used.push_back(main);
            const auto at = std::find_if(mains_.begin(), mains_.end(),
                                         [&](const auto& other) { return other.get() == main; });
            used.push_back(boundaries_[static_cast<std::size_t>(at - mains_.begin())].get());
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
    std::vector<std::unique_ptr<GpuView>> mains_, boundaries_;  ///< in the same order
    LayerSplitter splitter_;
    LayerPass blend_;
    LayerBlender blender_;
};

}  // namespace

SynthesiserEntry layered_synthesiser_entry() {
    return {
        "layered", "main layers with matted boundary layers, the two nearest rigs blended",
        [](const ShaderLibrary& library) { return std::make_unique<LayeredSynthesiser>(library); }};
}

}  // namespace vantage
