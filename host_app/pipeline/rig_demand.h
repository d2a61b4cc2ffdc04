#pragma once

#include <chrono>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "common/base/time/time.h"
#include "common/receive/frame_set.h"
#include "host_app/views/depth_view.h"

namespace vantage {

/// Decides which rigs must send, so that network and GPU load stay bounded on a large stage: those
/// that are most useful to the virtual views, by the surfaces that they showed last. A rig that
/// becomes useful is asked for at once; one that is no longer useful is stopped after a while,
/// since the camera may turn back. Belongs to one thread.
class RigDemand {
  public:
    /// Rigs that send for one view: those that a frame is rendered from, and a spare one for the
    /// camera's next move.
    static constexpr std::size_t most_rigs = 5;
    /// How long a rig keeps sending after it was last useful.
    static constexpr std::chrono::seconds hold{3};

    /// Updates the surfaces that the rigs show.
    void see(std::span<const DepthView> views);
    /// Forgets the rigs that a frame set has no slot for: they are removed from the stage.
    void forget_others(const FrameSet& set);

    struct Change {
        std::string rig;
        bool streaming;
    };
    /// Returns the rigs that must start or stop sending; empty if nothing changes. A new rig counts
    /// as sending.
    std::vector<Change> update(std::span<const VirtualView> targets, MonotonicTime now);

  private:
    struct Rig {
        SurfaceSamples samples;
        Eigen::Vector3d centre_m;
        bool streaming = true;
        MonotonicTime last_needed{};
    };
    std::map<std::string, Rig> rigs_;
};

}  // namespace vantage
