#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "common/base/time/pulse_grid.h"
#include "common/base/time/time.h"

namespace vantage {

/// A label of a frame as people type it: "hh:mm:ss:ff", drop-frame or not with ':' or ';' between
/// the numbers, or "hh:mm:ss" for the first frame of the second. Every place that reads a typed
/// time code reads it through this.
struct TimeLabel {
    int hours = 0, minutes = 0, seconds = 0;
    std::optional<int> frame = {};

    /// Nothing: the text is no label.
    static std::optional<TimeLabel> parse(std::string_view text);
    /// True where this has no frame, or the same one.
    bool matches(const TimeLabel& whole) const;
};

/// Gives instants the house's time of day as SMPTE ST 12-1 time code: local time of this process
/// (its computer's zone, or use_time_zone()), and the number of the frame.
///
/// At 29.97, 59.94 and 119.88 frames a second it is drop-frame code "hh:mm:ss;ff": frames are
/// counted from the first one after local midnight, and of every minute but each tenth the first
/// numbers are left out, so that it is never five frames off the clock; at midnight it is set
/// anew. At other rates it is "hh:mm:ss:ff", frames counted within each second. Above 60 frames a
/// second two or more share a number. Where the clock is set forward or back for summer and winter
/// so is the code.
class TimecodeClock {
  public:
    /// Precondition: 0.001 <= rate_hz <= 1e6.
    explicit TimecodeClock(double rate_hz);

    /// Of a frame of the stage's pulse. `tai_offset_s`: of the clock that the pulses are read from,
    /// ahead of UTC (RigSync's of the rig, KernelClock's of this computer): 37 on one that knows
    /// TAI, 0 on one that nobody told.
    std::string of_pulse(std::uint64_t trigger_index, int tai_offset_s) const;
    /// The first pulse from `first` to `last` that has this label; nothing where none has.
    std::optional<std::uint64_t> find(const TimeLabel& label, std::uint64_t first,
                                      std::uint64_t last, int tai_offset_s) const;
    /// Why no frame of any day has this label at this rate, as the rest of a sentence that begins
    /// with it; empty where one has.
    std::string why_never(const TimeLabel& label) const;

    /// Of the frame that begins at `instant` or was the last one to begin before it.
    std::string at(TaiTime instant, int tai_offset_s) const {
        return of_pulse(grid_.index_at_or_before(instant), tai_offset_s);
    }

  private:
    PulseGrid grid_;
    int frames_a_number_;   ///< above 60 Hz
    int numbers_a_second_;  ///< nominal: 30 for 29.97
    bool is_drop_frame_;
};

}  // namespace vantage
