#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/base/pulse_grid.h"
#include "common/wire/frame_message.h"

namespace vantage {

/// Starts a take in order: every rig arms and says that it is ready, then the first pulse is
/// announced, then it comes. A take that runs already, as after the host was started anew, goes on
/// with its pulses; a rig that comes later joins them. A rig that does not come holds up the others
/// for so long and no longer. Clocks come in as arguments.
class TakeStarter {
  public:
    struct Rig {
        bool connected = false;
        RigSync sync;
    };

    /// Rigs that are not ready are waited for this long after the first one was.
    static constexpr std::chrono::seconds longest_wait{15};
    /// From the announcement to the first pulse: several heartbeats.
    static constexpr std::chrono::seconds notice{1};

    explicit TakeStarter(const PulseGrid& grid) : grid_(grid) {}

    /// To be called again and again; the first pulse once it is known.
    std::optional<std::uint64_t> update(const std::vector<Rig>& rigs, TaiTime tai,
                                        MonotonicTime now);

  private:
    PulseGrid grid_;
    std::optional<std::uint64_t> first_pulse_;
    std::optional<MonotonicTime> first_ready_;
};

}  // namespace vantage
