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
    bool is_armed = false;          ///< lead and follow: the line is held
    std::uint64_t first_pulse = 0;  ///< from which on pulses are sent; 0: not announced yet
    std::uint64_t pulses = 0;       ///< lead: sent; follow: seen
    std::uint64_t skipped = 0;      ///< lead: would have been too late; follow: had no edge
    std::uint64_t clock_steps = 0;
    std::uint64_t stray_edges = 0;     ///< follow: edges that belong to no pulse of the stage
    std::uint64_t unsynchronized = 0;  ///< frames without a pulse of their own
    Percentiles lateness_us;           ///< lead: of the pulses; follow: of the edges, by the grid
};

/// The trigger of a rig in its role: sends pulses (lead) or watches another rig's (follow), and
/// says which pulse exposed a frame. For the role free there is none. Thread-safe.
class RigTrigger {
  public:
    /// Takes the line. Null for the role free. Throws Error if the line or the timing cannot be
    /// had.
    static std::unique_ptr<RigTrigger> make(const RigConfig& config);
    virtual ~RigTrigger() = default;

    /// The host's word: pulses begin with this one, or with the next where it has passed. Throws
    /// Error, and leaves all as it is, for one so far ahead that the host counts at another rate.
    virtual void announce(std::uint64_t first_pulse) = 0;

    /// The pulse of the frame with this time stamp; empty: unsynchronized.
    virtual std::optional<std::uint64_t> index_of(TaiTime stamp) = 0;
    /// CLOCK_TAI was set: what is known of pulses before belongs to another count.
    virtual void clock_was_set() = 0;
    /// Pulses sent or seen so far.
    virtual std::uint64_t pulses() const = 0;
    /// Pulses since the first frame for which none came.
    virtual std::uint64_t missed() const = 0;
    /// The centre of exposure of a frame with this time stamp.
    virtual TaiTime exposure_centre(TaiTime stamp) const = 0;

    virtual TriggerStatus status() const = 0;
    /// Throws the Error that ended the pulses, if one did.
    virtual void rethrow_failure() const = 0;
    /// Lines for the start-up report.
    virtual std::vector<std::string> report() const = 0;
};

}  // namespace vantage
