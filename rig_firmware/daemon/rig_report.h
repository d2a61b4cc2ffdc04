#pragma once

#include <atomic>
#include <string>
#include <vector>

#include "common/config/rig_config.h"

namespace vantage {

/// Support report of a rig, as JSON: version, configuration, start-up report, last log lines,
/// kernel and system, and the output of `vantage-rig probe`. The probe runs in a child process for
/// at most 20 s, and is skipped once `stopping` is true. Secrets are removed (without_secrets). The
/// report has at most max_report_bytes.
std::string rig_report(const RigConfig& config, const std::vector<std::string>& said_at_start,
                       const std::atomic<bool>& stopping);

}  // namespace vantage
