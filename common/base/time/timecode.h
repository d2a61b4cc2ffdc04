#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "common/base/time/pulse_grid.h"
#include "common/base/time/time.h"

namespace vantage {

/// A label of a frame as people type it: "hh:mm:ss:ff", drop-frame or not with ':' or ';' between
/// the numbers, or "hh:mm:ss" for the first frame of the second. "Z" or an offset from UTC such as
/// "+01:00" may follow. Every place that reads a typed time code reads it through this.
struct TimeLabel {
    int hours = 0, minutes = 0, seconds = 0;
    std::optional<int> frame = {};
    std::optional<int> utc_offset_s = {};  ///< seconds ahead of UTC; empty: local time

    /// Nothing: the text is no label.
    static std::optional<TimeLabel> parse(std::string_view text);
    /// Compares the numbers. True where this has no frame, or the same one.
    bool matches(const TimeLabel& whole) const;
};

/// Computes SMPTE ST 12-1 time code for frames: the local time of day (of the computer's zone, or
/// of use_time_zone()) and the frame's number within the second.
///
/// At 29.97, 59.94 and 119.88 fps it is drop-frame code "hh:mm:ss;ff". Frames are counted from the
/// first one after local midnight, and the first numbers of every minute except each tenth are
/// skipped, so that the label is never five frames off the clock; the count restarts at midnight.
/// At other rates it is "hh:mm:ss:ff" with frames counted within each second. Above 60 fps two or
/// more frames share a number. The label follows daylight saving time.
class TimecodeClock {
  public:
    /// Precondition: 0.001 <= rate_hz <= 1e6.
    explicit TimecodeClock(double rate_hz);

    /// The label of the frame at a trigger pulse. `tai_offset_s`: by how much the pulses' clock is
    /// ahead of UTC (from RigSync for a rig, from KernelClock for this computer): 37 where TAI is
    /// set, 0 where it is not.
    std::string of_pulse(std::uint64_t trigger_index, int tai_offset_s) const;
    /// Returns the pulse from `first` to `last` that has this label, or nothing. If several pulses
    /// share a number it is the first of them. If the label occurs twice, since clocks were set
    /// back, it is the later one, and the log says so.
    std::optional<std::uint64_t> find(const TimeLabel& label, std::uint64_t first,
                                      std::uint64_t last, int tai_offset_s) const;
    /// Returns why no frame of any day has this label at this rate, as the rest of a sentence that
    /// begins with the label; empty if some frame has it.
    std::string why_never(const TimeLabel& label) const;

    /// The label of the last frame that began at or before `instant`.
    std::string at(TaiTime instant, int tai_offset_s) const {
        return of_pulse(grid_.index_at_or_before(instant), tai_offset_s);
    }

  private:
    /// The label in the zone of that offset; empty: local time.
    TimeLabel label_of(std::uint64_t pulse, int tai_offset_s,
                       std::optional<int> utc_offset_s) const;
    std::optional<std::uint64_t> find_last(const TimeLabel& label, std::uint64_t first,
                                           std::uint64_t last, int tai_offset_s) const;

    PulseGrid grid_;
    int frames_per_number_;   ///< above 1 only above 60 fps
    int numbers_per_second_;  ///< nominal: 30 for 29.97
    bool is_drop_frame_;
};

}  // namespace vantage
