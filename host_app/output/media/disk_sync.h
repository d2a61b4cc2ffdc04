#pragma once

#include <atomic>
#include <filesystem>
#include <thread>

#include "common/base/files/unique_fd.h"

namespace vantage {

/// Flushes a file to its disk once a second on a thread of its own. A power cut then loses about
/// one second, and the writer never waits for the disk.
class DiskSync {
  public:
    /// The file must exist.
    explicit DiskSync(const std::filesystem::path& path);

    /// Flushes the file now and waits for it.
    void now();
    /// errno of a failed flush; 0: none. write() may still succeed in the meantime, until memory or
    /// the file system is full.
    int failure() const { return failure_; }

  private:
    UniqueFd fd_;
    std::atomic<int> failure_ = 0;
    std::jthread thread_;
};

}  // namespace vantage
