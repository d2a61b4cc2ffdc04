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

/// Recorder of everything that the rig publishes, with or without a host. It writes consecutive
/// files of some minutes each and loses no frame between them. It erases the oldest files when all
/// together are too large, when they are older than the configured hours, or when the disk is full.
/// A KeepLedger determines order and age, never the time of day; each erasure is logged and
/// counted. If pulse indices decrease, as after a clock was set back, it starts the next file.
/// After a disk error it tries again. Thread-safe.
class TakeKeeper {
  public:
    /// Throws Error if the folder cannot be created or written to.
    TakeKeeper(const RigConfig::Keep& config, std::string rig, double rate_hz);
    ~TakeKeeper();
    TakeKeeper(const TakeKeeper&) = delete;
    TakeKeeper& operator=(const TakeKeeper&) = delete;

    /// Queues a frame for recording. Never waits.
    void offer(const std::shared_ptr<const PackedFrame>& frame);

    /// Files that were erased since the start.
    std::uint64_t erased() const;
    /// One status line for operators: recorded files, erased files and errors.
    std::string line() const;

  private:
    void run();
    void begin();
    void rotate(bool pulses_go_back);
    void erase_oldest(bool disk_is_full);

    const RigConfig::Keep config_;
    const std::string rig_;
    KeepLedger ledger_;  ///< used by the constructor, then by the thread only
    TakeRecorder recorder_;
    mutable std::mutex mutex_;
    std::condition_variable woken_;
    bool is_stopping_ = false;
    std::uint64_t last_pulse_ = 0;
    bool pulses_went_back_ = false;
    /// Frames for the next file, until it is open.
    std::deque<std::shared_ptr<const PackedFrame>> held_;
    std::uint64_t erased_ = 0;
    std::string last_erased_;  ///< name and reason
    std::size_t files_ = 0;
    std::uint64_t bytes_ = 0;
    std::thread thread_;
};

}  // namespace vantage
