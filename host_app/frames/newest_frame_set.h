#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "host_app/frames/stage_feed.h"

namespace vantage {

/// Frames by rig, by name.
using RigCounts = std::map<std::string, std::uint64_t>;
void count_frames(const FrameSet& set, RigCounts& counts);

/// Takes sets off a feed on a thread of its own and keeps the newest, so that a slow picture never
/// holds up what arrives. A set that is replaced before it was taken is counted as superseded.
class NewestFrameSet {
  public:
    explicit NewestFrameSet(StageFeed feed);
    ~NewestFrameSet();
    NewestFrameSet(const NewestFrameSet&) = delete;
    NewestFrameSet& operator=(const NewestFrameSet&) = delete;

    /// The newest set, if it was not taken yet; waits for one until the time is up. Throws what the
    /// feed threw.
    std::optional<FrameSet> take(std::chrono::nanoseconds timeout = std::chrono::nanoseconds(0));

    struct Superseded {
        std::uint64_t sets = 0;
        RigCounts frames;
    };
    Superseded superseded() const;
    ReceiverStatus status() const { return feed_.status(); }
    void ask(const std::string& rig, bool streaming) const {
        if (feed_.ask) feed_.ask(rig, streaming);
    }

    /// Ends the thread and balances the books: whatever the feed closed and nobody took counts as
    /// superseded. Returns the feed's status of that moment; take() gives nothing any more.
    ReceiverStatus close();

  private:
    void stop();
    void run();
    void supersede(const FrameSet& set);

    StageFeed feed_;
    mutable std::mutex mutex_;
    std::condition_variable arrived_;
    std::optional<FrameSet> newest_;
    Superseded superseded_;
    std::exception_ptr failure_;
    std::uint64_t taken_off_ = 0;  ///< sets that the feed gave
    bool stopping_ = false;
    std::thread thread_;
};

}  // namespace vantage
