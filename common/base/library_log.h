#pragma once

#include <cstdint>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "common/base/log.h"
#include "common/base/log_limiter.h"

namespace vantage {

/// Writes the messages of one third-party library to our log: at most one line in ten seconds, with
/// the number of messages since the last line. Objects are static, one for each library.
/// Thread-safe.
class LibraryLog {
  public:
    /// Messages at `level` below the log's threshold are counted only.
    LibraryLog(std::string library, LogLevel level);
    LibraryLog(const LibraryLog&) = delete;
    LibraryLog& operator=(const LibraryLog&) = delete;

    void note(std::string message);

    /// The libraries that wrote messages, with their numbers, for bug reports.
    static std::vector<std::pair<std::string, std::uint64_t>> counts();

  private:
    const std::string library_;
    const LogLevel level_;
    std::mutex mutex_;
    LogLimiter limiter_{std::chrono::seconds(10)};
};

/// Writes libsrt's messages to our log, for srt_setloghandler(). Its threads call it, for a refused
/// caller four times in 10 ms. What its error correction says of lost packets is only counted.
void keep_srt_message(void* unused, int level, const char* file, int line, const char* area,
                      const char* message);

}  // namespace vantage
