#pragma once

#include <atomic>
#include <string>
#include <vector>

#include "common/config/rig_config.h"

namespace vantage {

/// What a rig says of itself for help, as JSON: version, its configuration, what it said at start,
/// its last log lines, the computer's kernel and system, and what `vantage-rig probe` finds (run
/// beside the daemon, 20 s at most, and not once this is to stop). Nothing secret
/// (without_secrets). At most max_report_bytes.
std::string rig_report(const RigConfig& config, const std::vector<std::string>& said_at_start,
                       const std::atomic<bool>& stopping);

}  // namespace vantage
