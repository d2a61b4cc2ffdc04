#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <memory>
#include <string>

#include "common/take/take_reader.h"
#include "common/wire/kept_parts.h"

namespace vantage {

/// Looks up frames in the files that a rig records, including the file that is being written. Use
/// it from one thread.
class KeptReader {
  public:
    KeptReader(std::filesystem::path folder, std::string rig, double rate_hz);

    /// Returns the first recorded frame whose pulse is at least `from` and below `to`, complete
    /// with all its parts; null if there is none. Skips frames without a pulse of the stage and
    /// damaged frames.
    std::shared_ptr<const KeptParts> first_of(std::uint64_t from, std::uint64_t to);

  private:
    struct Open {
        std::filesystem::path path;
        std::uint64_t bytes = 0;                 ///< size of the file when it was read
        std::shared_ptr<const TakeReader> take;  ///< null if the file cannot be read
        MonotonicTime read{};
    };
    /// Returns null if the file cannot be read.
    std::shared_ptr<const TakeReader> open(const std::filesystem::path& path, std::uint64_t bytes,
                                           std::uint64_t from);

    std::filesystem::path folder_;
    std::string rig_;
    double rate_hz_;
    std::deque<Open> opened_;  ///< most recently used first
};

}  // namespace vantage
