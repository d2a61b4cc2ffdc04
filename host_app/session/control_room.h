#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/take/take_recorder.h"
#include "host_app/control/ports/control_ports.h"
#include "host_app/output/frame_set_timecode.h"
#include "host_app/session/air_watch.h"
#include "host_app/session/live_show.h"

namespace vantage {

/// The control ports of a show, and the tally, lamps and time code that are exchanged with them.
/// Used on the session's thread.
class ControlRoom {
  public:
    /// Opens the ports. Throws Error as ControlPorts does. The show must outlive this object.
    ControlRoom(const std::vector<std::string>& urls, LiveShow& show);

    /// Updates the lamps. Call it often. `take` is nothing if no take can be recorded, and
    /// `verdict` is null before the first.
    void show_lamps(const LiveShow& show, const std::optional<TakeState>& take,
                    const AirVerdict* verdict, const std::string& saved_background,
                    MonotonicTime now);
    /// Updates the lamps even without ports, for lamps().
    void keep_lamps() { keeps_lamps_ = true; }
    /// Whether anything shows the lamps.
    bool has_lamps() const { return ports_ || keeps_lamps_; }
    const ShowLamps& lamps() const { return shown_; }
    Tally::State tally() const { return tally_.state(); }
    LtcBoard::State ltc() const { return ltc_.state(); }
    /// The ports' counters so far.
    std::vector<PortState> ports() const;
    /// Closes the ports and returns their final counters.
    std::vector<PortState> close();

  private:
    void show_replay(const ProgrammeState& state);

    Tally tally_;
    LampBoard lamps_;
    LtcBoard ltc_;
    std::optional<SetTimecode> timecodes_;
    ShowLamps shown_;
    bool keeps_lamps_ = false;
    MonotonicTime timecode_shown_{};
    std::optional<ControlPorts> ports_;
};

}  // namespace vantage
