#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include "host_app/sound/sound_ring.h"

namespace vantage {

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
