#pragma once

#include <chrono>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "common/base/time/time.h"
#include "host_app/views/depth_view.h"
#include "host_app/views/surface_samples.h"
#include "host_app/views/virtual_view.h"

namespace vantage {

/// Which rigs the virtual views need, so that network and GPU load stay bounded while the stage
/// grows: the most useful ones, by what they showed when they were last seen. One that becomes
/// useful is asked for at once; one that is no longer is let go only after a while, for the camera
/// may turn back.
class RigDemand {
  public:
    /// Rigs that send for a view: those of one picture, and one to spare for the camera's next
    /// move.
    static constexpr std::size_t most_rigs = 5;
    static constexpr std::chrono::seconds hold{3};

    /// Takes note of what rigs show.
    void see(std::span<const DepthView> views);

    struct Change {
        std::string rig;
        bool streaming;
    };
    /// What to ask of which rig from now on; empty as long as nothing changes. Rigs send until they
    /// are told otherwise.
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
