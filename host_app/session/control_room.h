#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/take/take_recorder.h"
#include "host_app/control/ports/control_ports.h"
#include "host_app/output/frame_set_timecode.h"
#include "host_app/session/live_show.h"

namespace vantage {

/// The ports of a show by which others steer it, and what they are shown.
class ControlRoom {
  public:
    /// Throws Error as ControlDesk. The show must outlive it.
    ControlRoom(const std::vector<std::string>& urls, LiveShow& show);

    /// To be called often, from the session's thread. `take`: nothing: none can be recorded.
    void show_lamps(const LiveShow& show, const std::optional<TakeState>& take,
                    const std::string& saved_background, MonotonicTime now);
    Tally::State tally() const { return tally_.state(); }
    LtcBoard::State ltc() const { return ltc_.state(); }
    /// What the ports have counted so far.
    std::vector<PortState> ports() const;
    /// Ends the ports; what they counted.
    std::vector<PortState> close();

  private:
    void show_replay(const ProgrammeState& state);

    Tally tally_;
    LampBoard lamps_;
    LtcBoard ltc_;
    std::optional<SetTimecode> timecodes_;
    ShowLamps shown_;
    MonotonicTime timecode_shown_{};
    std::optional<ControlPorts> desk_;
};

}  // namespace vantage
