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

/// Numbers of frames, by the name of the rig.
using RigCounts = std::map<std::string, std::uint64_t>;
void count_frames(const FrameSet& set, RigCounts& counts);

/// Reads frame sets from a feed on its own thread and keeps the newest, so that slow rendering
/// never delays reception. Frame sets that a newer one replaced before they were taken are counted.
/// Thread-safe.
class NewestFrameSet {
  public:
    explicit NewestFrameSet(StageFeed feed);
    ~NewestFrameSet();
    NewestFrameSet(const NewestFrameSet&) = delete;
    NewestFrameSet& operator=(const NewestFrameSet&) = delete;

    /// Takes the newest frame set, and waits for one until the timeout. Throws the error of the
    /// feed.
    std::optional<FrameSet> take(std::chrono::nanoseconds timeout = std::chrono::nanoseconds(0));

    /// Frame sets that were replaced by a newer one.
    struct Replaced {
        std::uint64_t sets = 0;
        RigCounts frames;
    };
    Replaced replaced() const;
    ReceiverStatus status() const { return feed_.status(); }
    void ask(const std::string& rig, bool streaming) const {
        if (feed_.ask) feed_.ask(rig, streaming);
    }

    /// Ends the thread and completes the counts: frame sets that were not taken count as replaced.
    /// Returns the status of the feed at that time. Afterwards take() returns nothing.
    ReceiverStatus close();

  private:
    void stop();
    void run();
    void count_replaced(const FrameSet& set);

    StageFeed feed_;
    mutable std::mutex mutex_;
    std::condition_variable arrived_;
    std::optional<FrameSet> newest_;
    Replaced replaced_;
    std::exception_ptr failure_;
    std::uint64_t taken_off_ = 0;  ///< number of frame sets read from the feed
    bool stopping_ = false;
    std::thread thread_;
};

}  // namespace vantage
