#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "common/base/time/time.h"

namespace vantage {

/// Determines which rigs count pulses in step. Every frame measures its rig's lead: index times
/// period minus the time of its arrival. The leads of one stage are equal up to the rigs'
/// latencies; a rig with another epoch or a free-running clock differs. The stage's step is the
/// lead on which most active rigs agree within the tolerance (ties: the current one), so that the
/// jump of one rig does not affect the others, and a jump of all is followed. Rigs at another rate
/// than the stage's count only if no rig is at the stage's rate. Clock readings are arguments; not
/// thread-safe.
class StageStep {
  public:
    struct Options {
        std::chrono::nanoseconds period;
        std::chrono::nanoseconds tolerance;      ///< between leads, and for a rig that is ahead
        std::chrono::nanoseconds silence_limit;  ///< a rig silent for longer does not count
        std::chrono::nanoseconds behind_limit;   ///< a rig further behind counts differently
    };

    /// Rigs that must be active for most of them to outvote one: of two, neither outvotes the
    /// other.
    static constexpr std::size_t fewest_to_outvote = 3;

    enum class Verdict { in_step, out_of_step };

    struct Result {
        Verdict verdict = Verdict::in_step;
        /// The stage's indices fell by more than behind_limit, so that earlier closed frame sets
        /// have no relation to new ones.
        bool began_anew = false;
    };

    StageStep(std::size_t rigs, const Options& options);

    /// Takes in a frame of pulse `trigger_index`. `new_session`: the rig's daemon was restarted.
    Result hear(std::size_t rig, std::uint64_t trigger_index, bool new_session,
                MonotonicTime arrival);

    /// Appends a rig, which has not sent a frame yet.
    void add_rig() { rigs_.emplace_back(); }

    /// Initially true for every rig.
    void set_at_stage_rate(std::size_t rig, bool is_at_it) { rigs_[rig].at_stage_rate = is_at_it; }

    /// When frames of pulse `trigger_index` arrive from most active rigs, by their leads. Rigs at
    /// another rate than the stage's count as in the election. Empty if fewer than three rigs
    /// count, since two cannot outvote each other.
    std::optional<MonotonicTime> due(std::uint64_t trigger_index, MonotonicTime now) const;

    /// Whether a frame came from the rig within the silence limit.
    bool active(std::size_t rig, MonotonicTime now) const;
    Verdict verdict(std::size_t rig) const;

  private:
    struct Rig {
        double lead_ns = 0;  ///< index times period minus arrival
        std::optional<MonotonicTime> heard;
        bool at_stage_rate = true;
    };

    double elect(MonotonicTime now) const;

    Options options_;
    std::vector<Rig> rigs_;
    std::optional<double> step_ns_;  ///< the lead of the stage
};

}  // namespace vantage
