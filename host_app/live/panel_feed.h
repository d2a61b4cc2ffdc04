#pragma once

#include <chrono>
#include <deque>
#include <map>
#include <optional>
#include <string>

#include "host_app/desk/operator_panel.h"
#include "host_app/live/flight_controls.h"
#include "host_app/live/rate_meter.h"

namespace vantage {

/// Puts together what the operator's screen tells, from the session's books. Rates, latencies and
/// the disparity pictures are looked at a few times a second, so that numbers can be read.
class PanelFeed {
  public:
    PanelState state(LiveSession& session, const Texture& picture, const OrbitView& view,
                     const FlightControls& controls, std::uint64_t pictures);

  private:
    void refresh(LiveSession& session, std::uint64_t pictures, MonotonicTime now);
    void refresh_disparities(const FrameSet& set);
    static std::optional<PanelNovelty> novelty_of(const LiveSession& session);
    PanelRig rig_of(const RigStatus& status, const FrameSet* set) const;

    std::optional<MonotonicTime> refreshed_;
    RateMeter picture_rate_;
    std::map<std::string, RateMeter> rig_rates_;
    std::map<std::string, Texture> disparities_;
    std::deque<float> latencies_ms_;
    std::uint64_t last_set_ = 0;  ///< sets shown when the latency was noted last
    std::string renderer_;
    PanelState state_;
};

}  // namespace vantage
