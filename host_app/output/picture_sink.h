#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "common/av/sound.h"
#include "common/base/time/time.h"
#include "common/base/time/timecode.h"
#include "common/image/image.h"
#include "common/receive/frame_set.h"
#include "host_app/flight/camera_state.h"

namespace vantage {

/// Offset of the rigs' clock from UTC in seconds (see TimecodeClock); empty if the frame set has no
/// rig.
inline std::optional<int> tai_offset_s_of(const FrameSet& set) {
    for (const FrameSet::Slot& slot : set.slots)
        if (slot.frame) return slot.frame->sync.tai_offset_s;
    return std::nullopt;
}

/// Computes the house time code of frame sets. `rate_hz` is the rate that the code counts: the
/// pulse rate on the screen, the film's rate in a film.
class SetTimecode {
  public:
    SetTimecode(double pulse_rate_hz, double rate_hz) : pulses_(pulse_rate_hz), clock_(rate_hz) {}

    /// Returns an empty text for a frame set without rigs.
    std::string of(const FrameSet& set) const {
        const std::optional<int> offset_s = tai_offset_s_of(set);
        return offset_s ? clock_.at(pulses_.time_of(set.trigger_index), *offset_s) : std::string();
    }

  private:
    PulseGrid pulses_;
    TimecodeClock clock_;
};

/// Result of one tick of the programme. Images and frame sets are shared and immutable.
struct ProgrammePicture {
    std::uint64_t tick = 0;  ///< counts from the first picture, without gaps
    MonotonicTime due{};     ///< when the tick was due; the picture may have come later
    ColourImage picture;     ///< without overlays
    ColourImage overlaid;    ///< for operators: with the source map if requested
    std::shared_ptr<const FrameSet> set;
    CameraState camera;                       ///< camera that the picture was rendered from
    std::string title;                        ///< one line for operators: time, subject and camera
    std::shared_ptr<const SoundBlock> sound;  ///< sound of the tick; null if the programme has none
};

/// Interface of a receiver of the programme. A sink that fails is closed and reported; the
/// programme and other sinks continue.
class PictureSink {
  public:
    virtual ~PictureSink() = default;
    /// Name for operators; empty if the sink is not an output and has no stats.
    virtual std::string name() const = 0;
    /// Never waits: frames that cannot be taken now are dropped and counted. Throws Error if the
    /// sink has failed.
    virtual void take(const ProgrammePicture& picture) = 0;
    /// Ends the sink; waiting frames are written. Throws Error if the sink has failed.
    virtual void finish() {}
};

}  // namespace vantage
