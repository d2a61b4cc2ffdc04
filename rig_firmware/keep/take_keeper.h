#pragma once

#include <condition_variable>
#include <deque>
#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "common/config/rig_config.h"
#include "common/take/take_recorder.h"
#include "rig_firmware/keep/keep_ledger.h"

namespace vantage {

/// The rig's own take, with or without a host: what it publishes goes to files of some minutes
/// each, one after the other without a frame between them. The oldest are erased when all together
/// are too large, when they are older than the hours asked for, or when the disk is full. Which is
/// the oldest, and how old it is, says a KeepLedger and never the clock of the day; each erasure is
/// logged and counted. When pulses go back, as after a clock that was set back, another file is
/// begun. A disk that fails is tried again. Thread-safe.
class TakeKeeper {
  public:
    /// Throws Error if the folder cannot be made or written to.
    TakeKeeper(const RigConfig::Keep& config, std::string rig, double rate_hz);
    ~TakeKeeper();
    TakeKeeper(const TakeKeeper&) = delete;
    TakeKeeper& operator=(const TakeKeeper&) = delete;

    /// Never waits.
    void offer(const std::shared_ptr<const PackedFrame>& frame);

    /// Files that were erased since the start.
    std::uint64_t erased() const;
    /// One line for people: what is kept, what was erased, and what is wrong.
    std::string line() const;

  private:
    void run();
    void begin();
    void rotate(bool pulses_go_back);
    void erase_oldest(bool disk_is_full);

    const RigConfig::Keep config_;
    const std::string rig_;
    KeepLedger ledger_;  ///< of the constructor, then of the thread
    TakeRecorder recorder_;
    mutable std::mutex mutex_;
    std::condition_variable woken_;
    bool is_stopping_ = false;
    std::uint64_t last_pulse_ = 0;
    bool pulses_went_back_ = false;
    /// Frames of after that, until the next file has begun.
    std::deque<std::shared_ptr<const PackedFrame>> held_;
    std::uint64_t erased_ = 0;
    std::string last_erased_;  ///< which, and why
    std::size_t files_ = 0;
    std::uint64_t bytes_ = 0;
    std::thread thread_;
};

}  // namespace vantage
