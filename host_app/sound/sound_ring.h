#pragma once

#include <cstdint>
#include <mutex>
#include <span>
#include <vector>

#include "common/av/sound.h"

namespace vantage {

/// A ring of the latest sound, addressed by sample number. One thread writes, others read, under a
/// lock held for a copy only.
class SoundRing {
  public:
    /// Precondition: capacity > 0, in samples.
    explicit SoundRing(std::size_t capacity);

    /// Writes the next samples. A gap before them becomes silence; samples that are there already
    /// stay. Returns the number of new samples.
    std::size_t write(std::int64_t first, std::span<const float> samples);
    /// Copies from sample `first`; missing samples are silent. Returns the number of found ones.
    std::size_t read(std::int64_t first, std::span<float> samples) const;
    /// Clears the ring; `first` is the next sample.
    void begin_at(std::int64_t first);

    std::int64_t begin() const;
    std::int64_t end() const;

  private:
    std::size_t place_of(std::int64_t sample) const;
    void put(std::int64_t first, std::span<const float> samples);

    mutable std::mutex mutex_;
    std::vector<float> samples_;
    std::int64_t capacity_, begin_ = 0, end_ = 0;
};

}  // namespace vantage
