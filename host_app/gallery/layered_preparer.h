#pragma once

#include <array>

#include "common/gl/fullscreen_pass.h"
#include "host_app/pipeline/instant_preparer.h"
#include "host_app/surfaces/recycle_pool.h"
#include "host_app/surfaces/rig_surface.h"

namespace vantage {

/// Splits a rig's view at depth edges into a main layer and a matted boundary layer, after Zitnick
/// et al., "High-quality video view interpolation using a layered representation" (2004).
class LayerSplitter {
  public:
    explicit LayerSplitter(const ShaderLibrary& library);

    /// Fills the depth and colour of two surfaces of the same camera from `source`. `main` gets
    /// everything except the nearer surface along depth edges, whose colour is also removed from
    /// mixed pixels. `boundary` gets a strip of the nearer surface along depth edges and no depth
    /// elsewhere; its alpha is the matte.
    void split(const RigSurface& source, RigSurface& main, RigSurface& boundary);

  private:
    struct Passes {
        FullscreenPass depth, colour;
    };
    std::array<Passes, 2> passes_;  ///< of the main layer and of the boundary layer
};

/// Every rig's view in two layers, after Zitnick et al. (2004): see LayerSplitter.
class LayeredPreparer final : public InstantPreparer {
  public:
    explicit LayeredPreparer(const ShaderLibrary& library)
        : splitter_(library), triangles_(library) {}

    void take(std::span<const DepthView> views, double dt_s) override;
    std::shared_ptr<const Instant> prepare(const VirtualView& target,
                                           const PrepareLevel& level) override;

  private:
    RecyclePool<RigSurface> surfaces_;
    std::unique_ptr<ColourCorrector> corrector_;
    std::unique_ptr<DepthUploader> uploader_;
    LayerSplitter splitter_;
    TriangleBuilder triangles_;
    std::shared_ptr<const Instant> instant_ = std::make_shared<Instant>();
};

}  // namespace vantage
