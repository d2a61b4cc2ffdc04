#pragma once

#include <vector>

#include "calib_tools/commands/live_option.h"
#include "calib_tools/commands/rig_folders.h"
#include "calib_tools/health/rig_snapshot.h"

namespace vantage {

/// Takes one snapshot of every rig, from its folder or live from the running stage. A rig's
/// calibration is calibration.yaml in its folder or, live, the given file. Logs a warning if a rig
/// works with another calibration. Throws Error for files that cannot be read and rigs that do not
/// answer.
std::vector<RigSnapshot> take_snapshots(const std::vector<RigFolder>& rigs, const LiveOption& live,
                                        long long instant);

}  // namespace vantage
