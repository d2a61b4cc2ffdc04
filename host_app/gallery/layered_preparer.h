#pragma once

#include "host_app/gallery/layer_splitter.h"
#include "host_app/pipeline/instant_preparer.h"
#include "host_app/surfaces/recycle_pool.h"
#include "host_app/surfaces/triangle_builder.h"

namespace vantage {

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
