#pragma once

#include <cstdint>
#include <mutex>
#include <span>
#include <vector>

#include "common/av/sound.h"

namespace vantage {

/// The latest sound, by the numbers of its samples: one thread writes, others read; nobody waits
/// for more than a copy.
class SoundRing {
  public:
    /// Precondition: capacity > 0; samples.
    explicit SoundRing(std::size_t capacity);

    /// What comes next; samples between the last ones and these are silent, and what was written
    /// already stays. How many samples of these were new.
    std::size_t write(std::int64_t first, std::span<const float> samples);
    /// Copies from sample `first` on; what is not there is silent. How many were there.
    std::size_t read(std::int64_t first, std::span<float> samples) const;
    /// Nothing is there any more; the next is this sample.
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
