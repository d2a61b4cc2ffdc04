#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include "host_app/sound/sound_ring.h"

namespace vantage {

/// Sound that has to be read and decoded, on a thread of its own, some seconds before it is asked
/// for, so that whoever asks never waits. After a jump it is silent until that is read.
class SoundAhead {
  public:
    /// Samples of the block, of which as many come as it can hold; fewer: that is the end of all.
    /// Called by one thread. What it throws ends the reading.
    using Fetch = std::function<std::vector<float>(std::int64_t first, std::size_t count)>;
    /// Has read what comes after `first` when it returns. Throws what `fetch` throws.
    SoundAhead(Fetch fetch, std::int64_t first);
    ~SoundAhead();
    SoundAhead(const SoundAhead&) = delete;
    SoundAhead& operator=(const SoundAhead&) = delete;

    /// As SoundSource's.
    std::size_t read(std::int64_t first, std::span<float> samples);
    struct State {
        std::string failure;  ///< that ended the reading; empty: none did
        std::uint64_t fetched = 0;
        bool is_at_end = false;  ///< all of it was read
    };
    State state() const;

  private:
    /// One piece; false: there is enough for now.
    bool fetch_some(std::int64_t wanted);
    void run();

    Fetch fetch_;
    SoundRing ring_;
    std::int64_t next_;  ///< of the thread
    mutable std::mutex mutex_;
    std::condition_variable woken_;
    std::int64_t wanted_;
    bool is_ending_ = false;
    State state_;
    std::thread thread_;
};

}  // namespace vantage
