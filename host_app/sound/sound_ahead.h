#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <span>
#include <thread>
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

/// Reads and decodes sound on a thread of its own, some seconds before it is requested, so that
/// read() never waits. After a jump it is silent until the sound there has been read.
class SoundAhead {
  public:
    /// Fetches up to `count` samples from `first`; fewer mean the end of the sound. Called by one
    /// thread. An exception ends the reading.
    using Fetch = std::function<std::vector<float>(std::int64_t first, std::size_t count)>;
    /// Fetches the first part before it returns. Throws what `fetch` throws.
    SoundAhead(Fetch fetch, std::int64_t first);
    ~SoundAhead();
    SoundAhead(const SoundAhead&) = delete;
    SoundAhead& operator=(const SoundAhead&) = delete;

    /// See SoundSource::read().
    std::size_t read(std::int64_t first, std::span<float> samples);
    struct State {
        std::string failure;  ///< why reading ended; empty: no failure
        std::uint64_t fetched = 0;
        bool is_at_end = false;  ///< whether all sound was read
    };
    State state() const;

  private:
    /// Fetches one part; false: enough is there for now.
    bool fetch_some(std::int64_t wanted);
    void run();

    Fetch fetch_;
    SoundRing ring_;
    std::int64_t next_;  ///< used by the thread only
    mutable std::mutex mutex_;
    std::condition_variable woken_;
    std::int64_t wanted_;
    bool is_ending_ = false;
    State state_;
    std::thread thread_;
};

}  // namespace vantage
