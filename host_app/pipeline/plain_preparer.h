#pragma once

#include "host_app/pipeline/instant_preparer.h"
#include "host_app/surfaces/recycle_pool.h"
#include "host_app/surfaces/triangle_builder.h"

namespace vantage {

/// The rigs' pictures and depth maps as they come, with the triangles of their grids.
class PlainPreparer final : public InstantPreparer {
  public:
    /// `takes_all`: views without depth too, whose surfaces are of one unknown pixel.
    explicit PlainPreparer(const ShaderLibrary& library, bool takes_all = false)
        : triangles_(library), takes_all_(takes_all) {}

    void take(std::span<const DepthView> views, double dt_s) override;
    std::shared_ptr<const Instant> prepare(const VirtualView& target,
                                           const PrepareLevel& level) override;

  private:
    RecyclePool<RigSurface> surfaces_;
    std::unique_ptr<ColourCorrector> corrector_;
    std::unique_ptr<DepthUploader> uploader_;
    TriangleBuilder triangles_;
    bool takes_all_;
    std::shared_ptr<const Instant> instant_ = std::make_shared<Instant>();
};

}  // namespace vantage
