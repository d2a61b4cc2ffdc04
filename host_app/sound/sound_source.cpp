#include "host_app/sound/sound_source.h"

#include <algorithm>
#include <exception>

#include "common/base/error.h"
#include "common/base/log.h"
#include "common/base/this_thread.h"

namespace vantage {
namespace {

OutputUrl url_of(const std::string& text) {
    OutputUrl url = OutputUrl::parse(text, "audio");
    if (url.scheme != "alsa" && url.scheme != "file")
        fail("the audio source {} is unknown: give alsa:DEVICE or a file", url.shown);
    return url;
}

}  // namespace

const char* key_of(SoundPhase phase) {
    switch (phase) {
        case SoundPhase::opening:
            break;
        case SoundPhase::on:
            return "on";
        case SoundPhase::failed:
            return "failed";
        case SoundPhase::ended:
            return "ended";
    }
    return "opening";
}

std::shared_ptr<SoundSource> open_sound(const std::string& text, SoundTap tap) {
    const OutputUrl url = url_of(text);
    return url.scheme == "alsa" ? open_alsa_sound(url, std::move(tap)) : open_file_sound(url);
}

void check_sound(const std::string& text) {
    const OutputUrl url = url_of(text);
    if (url.scheme == "alsa")
        check_alsa_sound(url);
    else
        (void)open_file_sound(url);
}

namespace {

constexpr std::int64_t kept_around = 16 * sound_rate_hz;
/// A programme that was held up takes the sound of that time at once.
constexpr std::int64_t read_ahead = 8 * sound_rate_hz;
constexpr std::int64_t fetched_at_once = sound_rate_hz / 5;
/// Kept before the last request, since sound may slide back.
constexpr std::int64_t slide_room = sound_rate_hz / 10;

}  // namespace

SoundRing::SoundRing(std::size_t capacity)
    : samples_(capacity * sound_channels), capacity_(static_cast<std::int64_t>(capacity)) {}

std::size_t SoundRing::place_of(std::int64_t sample) const {
    return static_cast<std::size_t>((sample % capacity_ + capacity_) % capacity_) * sound_channels;
}

void SoundRing::put(std::int64_t first, std::span<const float> samples) {
    while (!samples.empty()) {
        const std::size_t place = place_of(first);
        const std::size_t part = std::min(samples.size(), samples_.size() - place);
        std::copy_n(samples.begin(), part, samples_.begin() + static_cast<std::ptrdiff_t>(place));
        first += static_cast<std::int64_t>(part / sound_channels);
        samples = samples.subspan(part);
    }
}

std::size_t SoundRing::write(std::int64_t first, std::span<const float> samples) {
    const std::lock_guard lock(mutex_);
    const auto count = static_cast<std::int64_t>(samples.size() / sound_channels);
    if (begin_ == end_) begin_ = end_ = first;
    const std::int64_t known = std::clamp<std::int64_t>(end_ - first, 0, count);
    samples = samples.subspan(static_cast<std::size_t>(known) * sound_channels);
    const std::int64_t from = first + known;
    if (samples.empty()) return 0;
    if (from - end_ >= capacity_) {
        begin_ = end_ = from;
    } else {
        const std::vector<float> silence(static_cast<std::size_t>(from - end_) * sound_channels);
        put(end_, silence);
    }
    const auto most = static_cast<std::size_t>(capacity_) * sound_channels;
    const std::span<const float> kept = samples.last(std::min(samples.size(), most));
    end_ = first + count;
    put(end_ - static_cast<std::int64_t>(kept.size() / sound_channels), kept);
    begin_ = std::max(begin_, end_ - capacity_);
    return samples.size() / sound_channels;
}

std::size_t SoundRing::read(std::int64_t first, std::span<float> samples) const {
    std::fill(samples.begin(), samples.end(), 0.0F);
    const std::lock_guard lock(mutex_);
    const auto count = static_cast<std::int64_t>(samples.size() / sound_channels);
    const std::int64_t from = std::max(first, begin_), to = std::min(first + count, end_);
    for (std::int64_t at = from; at < to;) {
        const std::size_t place = place_of(at);
        const std::size_t part =
            std::min(static_cast<std::size_t>(to - at) * sound_channels, samples_.size() - place);
        std::copy_n(samples_.begin() + static_cast<std::ptrdiff_t>(place), part,
                    samples.begin() + static_cast<std::ptrdiff_t>(
                                          static_cast<std::size_t>(at - first) * sound_channels));
        at += static_cast<std::int64_t>(part / sound_channels);
    }
    return static_cast<std::size_t>(std::max<std::int64_t>(0, to - from));
}

void SoundRing::begin_at(std::int64_t first) {
    const std::lock_guard lock(mutex_);
    begin_ = end_ = first;
}

std::int64_t SoundRing::begin() const {
    const std::lock_guard lock(mutex_);
    return begin_;
}

std::int64_t SoundRing::end() const {
    const std::lock_guard lock(mutex_);
    return end_;
}

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
