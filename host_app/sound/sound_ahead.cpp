#include "host_app/sound/sound_ahead.h"

#include <exception>

#include "common/base/log.h"
#include "common/base/this_thread.h"

namespace vantage {
namespace {

constexpr std::int64_t kept_around = 16 * sound_rate_hz;
/// A programme that was held up takes the sound of that time at once.
constexpr std::int64_t read_ahead = 8 * sound_rate_hz;
constexpr std::int64_t fetched_at_once = sound_rate_hz / 5;
/// Kept before the last request, since sound may slide back.
constexpr std::int64_t slide_room = sound_rate_hz / 10;

}  // namespace

SoundAhead::SoundAhead(Fetch fetch, std::int64_t first)
    : fetch_(std::move(fetch)),
      ring_(static_cast<std::size_t>(kept_around)),
      next_(first),
      wanted_(first) {
    ring_.begin_at(first);
    while (fetch_some(first))
        ;
    thread_ = std::thread([this] { run(); });
}

SoundAhead::~SoundAhead() {
    {
        const std::lock_guard lock(mutex_);
        is_ending_ = true;
    }
    woken_.notify_all();
    thread_.join();
}

std::size_t SoundAhead::read(std::int64_t first, std::span<float> samples) {
    const std::size_t there = ring_.read(first, samples);
    {
        const std::lock_guard lock(mutex_);
        wanted_ = first;
    }
    woken_.notify_all();
    return there;
}

SoundAhead::State SoundAhead::state() const {
    const std::lock_guard lock(mutex_);
    return state_;
}

bool SoundAhead::fetch_some(std::int64_t wanted) {
    if (wanted < ring_.begin() || wanted > next_ + read_ahead) {
        next_ = wanted - slide_room;
        ring_.begin_at(next_);
        const std::lock_guard lock(mutex_);
        state_.is_at_end = false;
    }
    {
        const std::lock_guard lock(mutex_);
        if (state_.is_at_end) return false;
    }
    if (next_ >= wanted + read_ahead) return false;
    const std::vector<float> samples = fetch_(next_, static_cast<std::size_t>(fetched_at_once));
    const std::size_t count = samples.size() / sound_channels;
    ring_.write(next_, samples);
    next_ += static_cast<std::int64_t>(count);
    const std::lock_guard lock(mutex_);
    state_.fetched += count;
    state_.is_at_end = count < static_cast<std::size_t>(fetched_at_once);
    return true;
}

void SoundAhead::run() {
    name_this_thread("sound");
    try {
        for (;;) {
            std::int64_t wanted = 0;
            {
                const std::lock_guard lock(mutex_);
                if (is_ending_) return;
                wanted = wanted_;
            }
            if (fetch_some(wanted)) continue;
            std::unique_lock lock(mutex_);
            woken_.wait(lock, [&] { return is_ending_ || wanted_ != wanted; });
        }
    } catch (const std::exception& error) {
        log_error("the sound is silent from here on: {}", error.what());
        const std::lock_guard lock(mutex_);
        state_.failure = error.what();
    }
}

}  // namespace vantage
