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

/// Records everything that the rig publishes, with or without a host, to consecutive files of some
/// minutes each, without a lost frame between them. The oldest files are erased when all together
/// are too large, when they are older than the hours asked for, or when the disk is full. A
/// KeepLedger determines order and age, never the time of day; each erasure is logged and counted.
/// If pulse indices go back, as after a clock that was set back, the next file is started. A disk
/// that failed is tried again. Thread-safe.
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
