#pragma once

#include <chrono>
#include <memory>
#include <mutex>
#include <optional>

#include "host_app/sound/picture_delay.h"
#include "host_app/sound/sound_source.h"

namespace vantage {

/// Computes the sound of every programme tick: what was heard at the exposure of the instant that
/// the tick shows. The sound is continuous: if it has to move slightly, it is stretched by up to
/// 0.5 %; a larger move is a jump with a crossfade, and is counted.
class PictureSound {
  public:
    struct Settings {
        double rate_hz = 30;  ///< of the programme
        /// From being heard to output; empty: the pictures' delay, or 0 for a file.
        std::optional<std::chrono::nanoseconds> delay = {};
        /// Gets the sound of all ticks with the times at which it would have been heard.
        SoundTap tap = {};
    };
    PictureSound(const Settings& settings, std::shared_ptr<SoundSource> source);

    /// The time of a tick and of its picture.
    struct Tick {
        TaiTime now{};                        ///< time of the tick
        std::optional<TaiTime> shown_time{};  ///< time that is shown, now or in the past; empty:
                                              ///< it stands, or does not advance at normal speed
    };
    /// The sound of the next tick. Called by one thread for every tick. Never waits.
    std::shared_ptr<const SoundBlock> next(const Tick& tick);
    /// Reports a picture's delay: from exposure to its tick, or, in a replay, behind the requested
    /// time.
    void saw_live(std::chrono::nanoseconds latency) { live_.see(latency); }
    void saw_past(std::chrono::nanoseconds latency) { past_.see(latency); }

    SoundState state() const;

  private:
    /// The first sample of the tick; empty for silence.
    std::optional<std::int64_t> wanted(const Tick& tick, std::int64_t first) const;
    std::chrono::nanoseconds delay(const Tick& tick) const;
    void give_to_tap(const Tick& tick, const SoundBlock& block);

    Settings settings_;
    std::shared_ptr<SoundSource> source_;
    SoundGrid grid_;
    std::int64_t tick_ = 0;
    std::optional<TaiTime> last_time_;      ///< of the previous tick
    std::optional<std::int64_t> position_;  ///< the next sample; empty: silence
    std::optional<std::int64_t> tapped_;    ///< the next sample for the tap
    PictureDelay live_, past_;

    mutable std::mutex mutex_;  ///< guards the reported state
    SoundState told_;
};

}  // namespace vantage
