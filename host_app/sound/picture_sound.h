#pragma once

#include <chrono>
#include <memory>
#include <mutex>
#include <optional>

#include "host_app/sound/picture_delay.h"
#include "host_app/sound/sound_source.h"

namespace vantage {

/// The sound of every tick of the programme: what was heard when the instant was exposed that the
/// tick shows. It goes on without a break whatever ticks and measurements do: where it is to leave
/// a little earlier or later it is stretched, by half a percent at the most, until it does; what is
/// too far for that is a jump, faded over and counted.
class PictureSound {
  public:
    struct Settings {
        double rate_hz = 30;  ///< of the programme
        /// From being heard to leaving; nothing: as long as pictures take. Of a file 0 then.
        std::optional<std::chrono::nanoseconds> delay = {};
        /// Gets what goes with ticks, by when it would have been heard; see SoundTap.
        SoundTap tap = {};
    };
    PictureSound(const Settings& settings, std::shared_ptr<SoundSource> source);

    /// What the next tick is of.
    struct Tick {
        TaiTime now{};                        ///< when it is
        std::optional<TaiTime> shown_time{};  ///< to which time has gone: now, or in the past;
                                              ///< nothing: it stands, or goes another way
    };
    /// Called by one thread, tick by tick. Never waits.
    std::shared_ptr<const SoundBlock> next(const Tick& tick);
    /// How long a picture took: from exposure to its tick, or, of the past, by how much it is
    /// behind the time that was asked for.
    void saw_live(std::chrono::nanoseconds latency) { live_.see(latency); }
    void saw_past(std::chrono::nanoseconds latency) { past_.see(latency); }

    SoundState state() const;

  private:
    /// The sample that is to begin the tick; nothing: silence is due.
    std::optional<std::int64_t> wanted(const Tick& tick, std::int64_t first) const;
    std::chrono::nanoseconds delay(const Tick& tick) const;
    void give_to_tap(const Tick& tick, const SoundBlock& block);

    Settings settings_;
    std::shared_ptr<SoundSource> source_;
    SoundGrid grid_;
    std::int64_t tick_ = 0;
    std::optional<TaiTime> last_time_;      ///< of the tick before
    std::optional<std::int64_t> position_;  ///< the next sample; nothing: silence goes on
    std::optional<std::int64_t> tapped_;    ///< the next sample of the tap
    PictureDelay live_, past_;

    mutable std::mutex mutex_;  ///< of what is told
    SoundState told_;
};

}  // namespace vantage
