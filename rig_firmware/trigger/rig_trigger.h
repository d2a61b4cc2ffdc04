#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/base/percentiles.h"
#include "common/base/time/time.h"
#include "common/config/rig_config.h"

namespace vantage {

struct TriggerStatus {
    bool is_armed = false;  ///< lead and follow: this program holds the line
    std::uint64_t first_pulse =
        0;  ///< index of the first pulse that is sent; 0 until a host announces it
    std::uint64_t pulses = 0;  ///< lead: pulses sent; follow: pulses seen
    std::uint64_t skipped =
        0;  ///< lead: pulses beyond the lateness limit; follow: pulses without an edge
    std::uint64_t clock_steps = 0;
    std::uint64_t stray_edges = 0;     ///< follow: edges that match no pulse of the stage
    std::uint64_t unsynchronized = 0;  ///< frames without a pulse of their own
    Percentiles lateness_us;  ///< lead: lateness of the pulses sent; follow: of the edges, relative
                              ///< to the grid
};

/// Trigger of a rig in its role: it sends pulses (lead) or receives those of another rig (follow),
/// and finds the pulse that exposed a frame. The role free has no trigger. Thread-safe.
class RigTrigger {
  public:
    /// Opens the line. Returns null for the role free. Throws Error if the line is not available or
    /// the timing is not possible.
    static std::unique_ptr<RigTrigger> make(const RigConfig& config);
    virtual ~RigTrigger() = default;

    /// Handles the host's announcement: pulses begin with this one, or with the next one if it has
    /// passed. Throws Error, and changes nothing, if the pulse is so far in the future that the
    /// host must count at another rate.
    virtual void announce(std::uint64_t first_pulse) = 0;

    /// Index of the pulse that exposed the frame with this time stamp; empty if the frame is
    /// unsynchronized.
    virtual std::optional<std::uint64_t> index_of(TaiTime stamp) = 0;
    /// Forgets earlier pulses after CLOCK_TAI was set, since they belong to another count.
    virtual void clock_was_set() = 0;
    /// Number of pulses sent or seen so far.
    virtual std::uint64_t pulses() const = 0;
    /// Number of pulses since the first frame that exposed no frame.
    virtual std::uint64_t missed() const = 0;
    /// Centre of the exposure of the frame with this time stamp.
    virtual TaiTime exposure_centre(TaiTime stamp) const = 0;

    virtual TriggerStatus status() const = 0;
    /// Throws the Error that ended the pulses, if there is one.
    virtual void rethrow_failure() const = 0;
    /// Lines for the start-up report.
    virtual std::vector<std::string> report() const = 0;
};

}  // namespace vantage
