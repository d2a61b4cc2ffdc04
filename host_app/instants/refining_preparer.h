#pragma once

#include <memory>
#include <vector>

#include "host_app/instants/colour_steadier.h"
#include "host_app/instants/depth_closer.h"
#include "host_app/instants/depth_steadier.h"
#include "host_app/instants/edge_trust.h"
#include "host_app/instants/instant_preparer.h"
#include "host_app/instants/plate_learner.h"
#include "host_app/instants/rig_consensus.h"
#include "host_app/instants/triangle_builder.h"

namespace vantage {

/// All that is done for a live picture: colour and depth filtered along time, the rigs' depth maps
/// bettered by each other and closed, colours judged by their nearness to depth edges.
class RefiningPreparer final : public InstantPreparer {
  public:
    explicit RefiningPreparer(const ShaderLibrary& library);

    void take(std::span<const DepthView> views, double dt_s) override;
    std::shared_ptr<const Instant> prepare(const VirtualView& target,
                                           const PrepareLevel& level) override;
    void forget() override;

  private:
    void publish(RigHistory& rig, const PrepareLevel& level);

    RecyclePool<RigSurface> surfaces_;
    std::vector<std::unique_ptr<RigHistory>> rigs_;
    ColourSteadier colour_steadier_;
    DepthSteadier depth_steadier_;
    DepthCloser closer_;
    RigConsensus consensus_;
    EdgeTrust edge_trust_;
    PlateLearner plates_;
    TriangleBuilder triangles_;
};

}  // namespace vantage
