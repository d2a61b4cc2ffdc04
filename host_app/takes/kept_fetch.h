#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <vector>

#include "common/config/stage_config.h"
#include "common/take/take_reader.h"
#include "host_app/takes/rig_fetch.h"

namespace vantage {

/// Fetches the rigs' own recordings to this host.
struct KeptFetch {
    /// The pulses to fetch, for a rig's TAI offset.
    std::function<PulseRange(int tai_offset_s)> range;
    std::shared_ptr<const TakeReader> take;  ///< its frames are not fetched; may be null
    std::vector<std::string> rigs;           ///< empty: all rigs of the stage
    std::filesystem::path folder;            ///< existing folder for the files
    double bytes_s = 20e6;                   ///< total rate limit
    std::chrono::nanoseconds patience = std::chrono::seconds(10);  ///< with a silent rig

    using Progress = std::function<void(const std::vector<FetchStats>&)>;
    /// Fetches from all rigs in parallel, and returns when each has sent all it has or failed, or
    /// when `is_stopped`. `progress` is called now and then. Throws Error for invalid keys,
    /// endpoints and names, and if the disk fails.
    std::vector<FetchStats> run(const StageConfig& stage, const std::function<bool()>& is_stopped,
                                const Progress& progress) const;
};

}  // namespace vantage
