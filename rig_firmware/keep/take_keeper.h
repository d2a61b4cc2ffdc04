#pragma once

#include <condition_variable>
#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "common/config/rig_config.h"
#include "common/take/take_recorder.h"

namespace vantage {

/// The rig's own take, with or without a host: what it publishes goes to files of some minutes
/// each, one after the other without a frame between them, and the oldest are dropped when all
/// together are too large or too old. A disk that fails is tried again. Thread-safe.
class TakeKeeper {
  public:
    /// Throws Error if the folder cannot be made or written to.
    TakeKeeper(const RigConfig::Keep& config, std::string rig, double rate_hz);
    ~TakeKeeper();
    TakeKeeper(const TakeKeeper&) = delete;
    TakeKeeper& operator=(const TakeKeeper&) = delete;

    /// Never waits.
    void offer(const std::shared_ptr<const PackedFrame>& frame);

    /// One line for people: what is kept, and what is wrong.
    std::string line() const;

  private:
    void run();
    void begin();
    void drop_oldest(bool at_least_one);

    const RigConfig::Keep config_;
    const std::string rig_;
    TakeRecorder recorder_;
    mutable std::mutex mutex_;
    std::condition_variable woken_;
    bool is_stopping_ = false;
    std::size_t files_ = 0;
    std::uint64_t bytes_ = 0;
    std::thread thread_;
};

}  // namespace vantage
