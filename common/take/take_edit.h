#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "common/take/take_reader.h"

namespace vantage {

struct TakeCopy {
    std::uint64_t frames = 0, cameras = 0;
    std::uint64_t damaged = 0;  ///< frames that are left out, since their bytes are not right
    std::uint64_t twice = 0;    ///< frames that another take had already
    double sound_s = 0;         ///< of sound that is in it
};

/// Writes all frames of the takes whose pulses are from `from` to before `to` to a new take, by
/// pulse, each as it is: nothing is coded anew. A rig may be in several takes; of a pulse that it
/// is in twice, the first sound frame is kept; of sound likewise, to the sample. The file is there
/// when it is whole. Throws Error if the takes do not fit together, or there is nothing to write,
/// or a file of that name.
TakeCopy copy_takes(const std::vector<const TakeReader*>& takes, std::uint64_t from,
                    std::uint64_t to, const std::filesystem::path& path,
                    const std::function<void(double)>& progress = {});

}  // namespace vantage
