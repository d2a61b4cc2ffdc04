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

/// Finds frames in the files that a rig keeps, also in the one that is being written. Belongs to
/// one thread.
class KeptReader {
  public:
    KeptReader(std::filesystem::path folder, std::string rig, double rate_hz);

    /// The first frame that is kept of the pulses `from` to before `to`, with all its bytes; null
    /// if none is. Frames without a pulse of the stage are none, and damaged ones are passed over.
    std::shared_ptr<const KeptParts> first_of(std::uint64_t from, std::uint64_t to);

  private:
    struct Open {
        std::filesystem::path path;
        std::uint64_t bytes = 0;                 ///< of the file when it was read
        std::shared_ptr<const TakeReader> take;  ///< null: none that can be read
        MonotonicTime read{};
    };
    /// Null: the file is none that can be read.
    std::shared_ptr<const TakeReader> open(const std::filesystem::path& path, std::uint64_t bytes,
                                           std::uint64_t from);

    std::filesystem::path folder_;
    std::string rig_;
    double rate_hz_;
    std::deque<Open> opened_;  ///< the last used comes first
};

}  // namespace vantage
