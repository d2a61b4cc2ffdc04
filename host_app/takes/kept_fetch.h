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

/// What is to be brought from the disks of a stage's rigs.
struct KeptFetch {
    /// The pulses, by what a rig's clock is from UTC.
    std::function<PulseRange(int tai_offset_s)> range;
    std::shared_ptr<const TakeReader> take;  ///< what is in it is not brought; may be null
    std::vector<std::string> rigs;           ///< of the stage; none: all
    std::filesystem::path folder;            ///< that is there
    double bytes_s = 20e6;                   ///< of all rigs together
    std::chrono::nanoseconds patience = std::chrono::seconds(10);  ///< with a rig that is silent

    using Progress = std::function<void(const std::vector<FetchStats>&)>;
    /// Brings it, all rigs side by side, and comes back when every rig has given what it keeps or
    /// came to an end otherwise, or when `is_stopped`. `progress` is called now and then. Throws
    /// Error for keys, endpoints and names that cannot be, and if the disk fails.
    std::vector<FetchStats> run(const StageConfig& stage, const std::function<bool()>& is_stopped,
                                const Progress& progress) const;
};

}  // namespace vantage
