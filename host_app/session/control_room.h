#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/base/time/rate_meter.h"
#include "common/take/take_recorder.h"
#include "host_app/control/ports/control_port.h"
#include "host_app/desk/air_verdict.h"
#include "host_app/output/picture_sink.h"
#include "host_app/session/live_show.h"

namespace vantage {

/// Whether the programme is fit to go on air, for control surfaces and the page for tablets. Used
/// on the session's thread; it costs the programme's thread nothing.
class AirWatch {
  public:
    struct Seen {
        LiveReport report;
        AirVerdict verdict;
        std::vector<DeskRig> rigs;  ///< in the order of the report
    };
    /// Looks again if the last time was a quarter of a second ago, and returns whether it did.
    /// `take` is nothing if none was recorded.
    bool follow(const LiveShow& show, const std::optional<TakeState>& take, MonotonicTime now);
    /// Empty before the first look.
    const std::optional<Seen>& seen() const { return seen_; }

  private:
    std::map<std::string, MonotonicTime> rigs_seen_;  ///< last time in a frame set
    RateMeter ticks_, repeats_;
    MonotonicTime refreshed_{};
    std::optional<Seen> seen_;
};

/// "ready", "caution" or "not_ready".
const char* key_of(AirVerdict::Level level);

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
