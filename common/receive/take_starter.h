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

/// Coordinates the start of the trigger pulses: every rig arms and reports that it is ready, then
/// the first pulse is announced, then it comes. If pulses already run, as after a restart of the
/// host, they continue. A rig that comes later joins them. An absent rig delays the others only up
/// to a limit. Clock readings are arguments. Not thread-safe.
class TakeStarter {
  public:
    struct Rig {
        bool connected = false;
        RigSync sync;
    };

    /// The longest wait for rigs that are not ready, after the first one was.
    static constexpr std::chrono::seconds longest_wait{15};
    /// The time from the announcement to the first pulse: several heartbeats.
    static constexpr std::chrono::seconds notice{1};
    /// A first pulse that a rig reports and that lies further ahead is not believed: the stage
    /// would wait for it. Clocks may differ by the TAI offset, 37 s.
    static constexpr std::chrono::seconds latest_start{60};
    /// A rig that is not ready this long after the announcement is reported; rigs become ready one
    /// after the other.
    static constexpr std::chrono::seconds ready_patience{3};

    explicit TakeStarter(const PulseGrid& grid) : grid_(grid) {}

    /// Call it periodically. Returns the first pulse once it is known.
    std::optional<std::uint64_t> update(const std::vector<Rig>& rigs, TaiTime tai,
                                        MonotonicTime now);

    /// The rigs that are not ready `ready_patience` after the announcement; each returned once.
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
