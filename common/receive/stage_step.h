#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "common/base/time/time.h"

namespace vantage {

/// Tells which rigs count pulses in step. Every frame says where its rig is: index times period,
/// less the time it came. Rigs of one stage agree in that up to their latencies; a rig that was
/// given another epoch, or whose clock runs free, stands apart. The stage's step is where most
/// active rigs agree within the tolerance (ties: where it was), so that one rig's jump takes
/// nothing from the others, and a jump of all is followed. Rigs at another rate than the stage's
/// count differently by nature: they have a say only where none is at the stage's. Clocks come in
/// as arguments; not thread-safe.
class StageStep {
  public:
    struct Options {
        std::chrono::nanoseconds period;
        std::chrono::nanoseconds tolerance;      ///< agreement, and how far ahead a rig may be
        std::chrono::nanoseconds silence_limit;  ///< a rig without frames this long has no vote
        std::chrono::nanoseconds behind_limit;   ///< further behind is another count, not lateness
    };

    enum class Verdict { in_step, out_of_step };

    struct Result {
        Verdict verdict = Verdict::in_step;
        /// The stage's indices fell back by more than behind_limit: what was closed before says
        /// nothing about what comes.
        bool began_anew = false;
    };

    StageStep(std::size_t rigs, const Options& options);

    /// A frame of pulse `trigger_index` came from this rig. `new_session`: its daemon was
    /// restarted.
    Result hear(std::size_t rig, std::uint64_t trigger_index, bool new_session,
                MonotonicTime arrival);

    /// At first every rig is.
    void set_at_stage_rate(std::size_t rig, bool is_at_it) { rigs_[rig].at_stage_rate = is_at_it; }

    /// A frame came from it within the silence limit.
    bool active(std::size_t rig, MonotonicTime now) const;
    Verdict verdict(std::size_t rig) const;

  private:
    struct Rig {
        double lead_ns = 0;  ///< index times period less arrival
        std::optional<MonotonicTime> heard;
        bool at_stage_rate = true;
    };

    double elect(MonotonicTime now) const;

    Options options_;
    std::vector<Rig> rigs_;
    std::optional<double> step_ns_;  ///< lead of the stage
};

}  // namespace vantage
