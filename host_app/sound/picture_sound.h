#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <cstdlib>
#include <memory>
#include <mutex>
#include <optional>

#include "host_app/sound/sound_source.h"

namespace vantage {

/// Estimates the pictures' delay, for sound that is output with them: the median of the latest
/// delays, updated only when it has moved noticeably. Not thread-safe.
class PictureDelay {
  public:
    void see(std::chrono::nanoseconds latency) {
        latest_[seen_++ % latest_.size()] = latency;
        const auto end =
            latest_.begin() + static_cast<std::ptrdiff_t>(std::min(seen_, latest_.size()));
        std::array<std::chrono::nanoseconds, most> sorted = latest_;
        const auto sorted_end = sorted.begin() + (end - latest_.begin());
        const auto middle = sorted.begin() + (sorted_end - sorted.begin()) / 2;
        std::nth_element(sorted.begin(), middle, sorted_end);
        // A third of a picture at 30 Hz.
        constexpr std::chrono::milliseconds unseen{10};
        if (seen_ == 1 || std::chrono::abs(*middle - now_) > unseen) now_ = *middle;
    }
    std::chrono::nanoseconds now() const { return now_; }
    std::size_t seen() const { return seen_; }

  private:
    /// Enough for some seconds.
    static constexpr std::size_t most = 127;
    std::array<std::chrono::nanoseconds, most> latest_{};
    std::size_t seen_ = 0;
    std::chrono::nanoseconds now_{0};
};

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
