#pragma once

#include <chrono>
#include <deque>
#include <map>
#include <optional>
#include <string>

#include "common/base/rate_meter.h"
#include "host_app/desk/operator_panel.h"
#include "host_app/live/live_show.h"

namespace vantage {

/// Puts together what the operator's screen tells, from the show's books. Rates, latencies and
/// the disparity pictures are looked at a few times a second, so that numbers can be read.
class PanelFeed {
  public:
    /// The context that shows it must be current at every call. `take`: nothing: none is recorded
    /// here.
    /// `question`: that a second press of a key answers; empty: none.
    PanelState state(LiveShow& show, const std::optional<TakeState>& take,
                     const std::string& question);

  private:
    void refresh(LiveShow& show, const ProgrammeState& programme, const FrameSet* set,
                 MonotonicTime now);
    void refresh_disparities(const FrameSet& set);
    static std::optional<PanelNovelty> novelty_of(const ProgrammeState& programme);
    PanelRig rig_of(const RigAccount& account, const FrameSet* set) const;

    std::optional<MonotonicTime> refreshed_;
    RateMeter picture_rate_;
    std::map<std::string, RateMeter> rig_rates_;
    std::map<std::string, Texture> disparities_;
    std::deque<float> latencies_ms_;
    double last_latency_ms_ = 0;
    std::string renderer_;
    std::optional<Texture> picture_;
    std::shared_ptr<const MadePicture> uploaded_;
    std::optional<SetTimecode> timecodes_;  ///< of the stage's pulses
    PanelState state_;
};

}  // namespace vantage
