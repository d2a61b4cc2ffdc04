#pragma once

#include <cmath>
#include <memory>

#include "common/base/time/pulse_grid.h"
#include "host_app/pipeline/instant_thread.h"
#include "host_app/replay/transport.h"
#include "host_app/sound/picture_sound.h"

namespace vantage {

/// Keeps PictureSound in step with the programme's picture: it measures the delay of the picture
/// and takes the sound of each tick. Without sound it does nothing. Used on the programme's thread
/// only.
class ProgrammeSound {
  public:
    /// `sound` may be null.
    ProgrammeSound(std::shared_ptr<PictureSound> sound, double rate_hz, double pulse_rate_hz)
        : sound_(std::move(sound)), rate_hz_(rate_hz), pulse_rate_hz_(pulse_rate_hz) {}

    /// Measures the delay of an instant whose frame is handed over now.
    void note_delay(const ReadyInstant& instant, const Transport& transport) {
        if (!sound_ || instant.number == measured_) return;
        measured_ = instant.number;
        if (instant.is_live) {
            if (instant.exposure) sound_->saw_live(TaiClock::now() - *instant.exposure);
        } else if (transport.is_at_normal_speed() && transport.pulse()) {
            const double shown = as_pulse(instant.set->trigger_index) + instant.share;
            sound_->saw_past(from_s((*transport.pulse() - shown) / pulse_rate_hz_));
        }
    }

    /// The sound of the tick that is `later` ticks after the one that was due at `due`, for which
    /// the transport was advanced. Null without sound.
    std::shared_ptr<const SoundBlock> next(MonotonicTime due, std::uint64_t later,
                                           const Transport& transport) {
        if (!sound_) return nullptr;
        const std::chrono::nanoseconds after = from_s(static_cast<double>(later) / rate_hz_);
        PictureSound::Tick tick;
        tick.now = TaiClock::now() - (MonotonicClock::now() - due) + after;
        if (transport.is_live()) {
            tick.shown_time = tick.now;
        } else if (const std::optional<double> pulse = transport.pulse();
                   pulse && transport.is_at_normal_speed()) {
            const double whole = std::floor(*pulse);
            tick.shown_time = PulseGrid(pulse_rate_hz_).time_of(static_cast<std::uint64_t>(whole)) +
                              from_s((*pulse - whole) / pulse_rate_hz_) + after;
        }
        return sound_->next(tick);
    }

  private:
    std::shared_ptr<PictureSound> sound_;
    double rate_hz_, pulse_rate_hz_;
    std::uint64_t measured_ = 0;  ///< number of the instant that was measured last
};

}  // namespace vantage
