#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "common/take/take_reader.h"

namespace vantage {

struct TakeCopy {
    std::uint64_t frames = 0, cameras = 0;
    std::uint64_t damaged = 0;  ///< frames left out because they are damaged
    std::uint64_t twice = 0;    ///< frames left out because an earlier take has them
    double sound_s = 0;         ///< copied sound
};

/// Copies the frames of the takes with pulses from `from` to before `to` to a new take, without
/// re-encoding. A rig may be in several takes: of each pulse the first undamaged frame is copied,
/// and sound likewise per sample. The file appears when it is complete. Throws Error if the takes
/// do not fit together, there is nothing to write, or the file exists.
TakeCopy copy_takes(const std::vector<const TakeReader*>& takes, std::uint64_t from,
                    std::uint64_t to, const std::filesystem::path& path,
                    const std::function<void(double)>& progress = {});

}  // namespace vantage
