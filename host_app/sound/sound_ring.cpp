#include "host_app/sound/sound_ring.h"

#include <algorithm>

namespace vantage {

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

}  // namespace vantage
