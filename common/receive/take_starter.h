#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/base/time/pulse_grid.h"
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
    /// Rigs become ready one after the other; who is not so long after the announcement is named.
    static constexpr std::chrono::seconds ready_patience{3};

    explicit TakeStarter(const PulseGrid& grid) : grid_(grid) {}

    /// To be called again and again; the first pulse once it is known.
    std::optional<std::uint64_t> update(const std::vector<Rig>& rigs, TaiTime tai,
                                        MonotonicTime now);

    /// Which rigs are not ready although the take's first pulse is known for a while: told once.
    std::vector<std::size_t> laggards(const std::vector<Rig>& rigs, MonotonicTime now);

  private:
    std::optional<std::uint64_t> find_first_pulse(const std::vector<Rig>& rigs, TaiTime tai,
                                                  MonotonicTime now);

    PulseGrid grid_;
    std::optional<std::uint64_t> first_pulse_;
    std::optional<MonotonicTime> first_ready_;
    std::optional<MonotonicTime> name_laggards_at_;
};

}  // namespace vantage
