#pragma once

#include <optional>
#include <string>

#include "common/base/time/timecode.h"
#include "common/receive/frame_set.h"

namespace vantage {

/// Of the clock of the rigs in the set, ahead of UTC (see TimecodeClock); nothing: none is in it.
std::optional<int> tai_offset_s_of(const FrameSet& set);

/// Gives sets of frames the house's time of day. `rate_hz` is that of what is counted: of the
/// pulses on the screen, of the film in a film.
class SetTimecode {
  public:
    SetTimecode(double pulse_rate_hz, double rate_hz) : pulses_(pulse_rate_hz), clock_(rate_hz) {}

    /// Empty for a set that no rig is in.
    std::string of(const FrameSet& set) const;

  private:
    PulseGrid pulses_;
    TimecodeClock clock_;
};

}  // namespace vantage
