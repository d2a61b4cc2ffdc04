#pragma once

#include "common/gl/fullscreen_pass.h"
#include "host_app/instants/recycle_pool.h"
#include "host_app/instants/rig_history.h"

namespace vantage {

/// Learns every rig's background plate along time: what a performer hides was seen before.
class PlateLearner {
  public:
    /// A pixel is told before no fewer instants; until then there is nothing to show.
    static constexpr int confirmations = 3;

    explicit PlateLearner(const ShaderLibrary& library) : learn_(library, "plate_learn.frag") {}

    /// Takes the view's newest depth and colour into its plate. Once an upload.
    void learn(RigHistory& view);

  private:
    FullscreenPass learn_;
    RecyclePool<RigPlate> pool_;
};

}  // namespace vantage
