#pragma once

#include <optional>
#include <string>

#include "common/base/time/timecode.h"
#include "common/receive/frame_set.h"

namespace vantage {

/// Offset of the rigs' clock from UTC in seconds (see TimecodeClock); empty if the frame set has no
/// rig.
std::optional<int> tai_offset_s_of(const FrameSet& set);

/// Computes the house time code of frame sets. `rate_hz` is the rate that the code counts: the
/// pulse rate on the screen, the film's rate in a film.
class SetTimecode {
  public:
    SetTimecode(double pulse_rate_hz, double rate_hz) : pulses_(pulse_rate_hz), clock_(rate_hz) {}

    /// Returns an empty text for a frame set without rigs.
    std::string of(const FrameSet& set) const;

  private:
    PulseGrid pulses_;
    TimecodeClock clock_;
};

}  // namespace vantage
