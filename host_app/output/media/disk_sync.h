#pragma once

#include <atomic>
#include <filesystem>
#include <thread>

#include "common/base/files/unique_fd.h"

namespace vantage {

/// Brings what is written to a file to its disk once a second, on a thread of its own, so that a
/// power cut costs no more, and whoever writes does not wait for it.
class DiskSync {
  public:
    /// The file is there.
    explicit DiskSync(const std::filesystem::path& path);

    /// At once, and waits for it.
    void now();
    /// The system's reason for what did not get there; 0: all did. write() may go on well
    /// meanwhile, until memory or the file system is full.
    int failure() const { return failure_; }

  private:
    UniqueFd fd_;
    std::atomic<int> failure_ = 0;
    std::jthread thread_;
};

}  // namespace vantage
