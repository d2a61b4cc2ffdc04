#pragma once

#include <atomic>
#include <string>
#include <vector>

#include "common/config/rig_config.h"

namespace vantage {

/// Lines of the support report that the daemon collects while it runs.
struct RigNotes {
    std::vector<std::string> at_start;     ///< lines of the start-up report
    std::vector<std::string> clock_steps;  ///< the last steps of this computer's clock
};

/// Support report of a rig, as JSON: version, configuration, notes, last log lines, last refused
/// inputs, kernel and system, and the output of `vantage-rig probe`. The probe runs in a child
/// process for at most 20 s, and is skipped once `stopping` is true. Secrets are removed
/// (without_secrets). The report has at most max_report_bytes.
std::string rig_report(const RigConfig& config, const RigNotes& notes,
                       const std::atomic<bool>& stopping);

}  // namespace vantage
