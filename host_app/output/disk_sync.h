#pragma once

#include <filesystem>
#include <thread>

#include "common/base/unique_fd.h"

namespace vantage {

/// Brings what is written to a file to its disk once a second, on a thread of its own, so that a
/// power cut costs no more, and whoever writes does not wait for it.
class DiskSync {
  public:
    /// The file is there.
    explicit DiskSync(const std::filesystem::path& path);

    /// At once, and waits for it.
    void now() const;

  private:
    UniqueFd fd_;
    std::jthread thread_;
};

}  // namespace vantage
