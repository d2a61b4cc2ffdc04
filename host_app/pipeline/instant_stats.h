#pragma once

#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "common/base/percentiles.h"
#include "host_app/background/background_access.h"
#include "host_app/frames/newest_frame_set.h"
#include "host_app/refine/gain_compensation.h"

namespace vantage {

/// How long each step of a frame took on the rigs.
struct RigSteps {
    Percentiles capture_ms, rectify_ms, match_ms, pack_ms;
};

/// Counters and timings of the instants that were prepared.
struct InstantStats {
    std::uint64_t prepared = 0;  ///< frame sets, live ones or those of a take
    std::uint64_t between = 0;   ///< instants interpolated between two pulses
    RigCounts frames;            ///< of the prepared frame sets
    /// Frame sets that a newer one replaced, and those that a fault left unprepared.
    NewestFrameSet::Replaced replaced;
    std::map<std::string, GainCompensation::Rig> gain_compensation;
    Percentiles prepare_ms;
    RigSteps rig_steps;
    std::vector<RigBackgroundState> backgrounds;  ///< empty: the preparer learns none
    int faults = 0;
};

/// Collects InstantStats so that every frame set is counted once: as prepared or as dropped.
/// snapshot() is safe on any thread; the other functions belong to the pipeline's thread.
class InstantStatsRecorder {
  public:
    /// Notes that this frame set is being prepared. It counts as dropped unless note_prepared()
    /// follows.
    void begin(const FrameSet& set) { unprepared_ = set; }
    /// Counts the frame set that is being prepared as dropped, if there is one.
    void drop() {
        const std::lock_guard lock(mutex_);
        drop_locked();
    }
    /// Counts a fault, and drops what was being prepared.
    void note_fault() {
        const std::lock_guard lock(mutex_);
        ++stats_.faults;
        drop_locked();
    }
    /// Leaves the frame set that is being prepared uncounted, for it is taken again.
    void cancel() { unprepared_.reset(); }

    struct Prepared {
        const FrameSet& set;
        bool is_counted = false;  ///< false for frame sets of the replay buffer: counted when live
        bool is_interpolated = false;
        double prepare_ms = 0;
        std::map<std::string, GainCompensation::Rig> gain_compensation;
        std::vector<RigBackgroundState> backgrounds;
    };
    void note_prepared(Prepared prepared);

    /// `replaced`: the frame sets that were never taken, which are counted elsewhere.
    InstantStats snapshot(NewestFrameSet::Replaced replaced) const;

  private:
    void drop_locked();

    std::optional<FrameSet> unprepared_;  ///< the frame set that is being prepared
    mutable std::mutex mutex_;
    InstantStats stats_;
    NewestFrameSet::Replaced dropped_;
    PercentileRecorder prepare_ms_, capture_ms_, rectify_ms_, match_ms_, pack_ms_;
};

}  // namespace vantage
