#pragma once

#include <vector>

#include "calib_tools/commands/live_option.h"
#include "calib_tools/commands/rig_folders.h"
#include "calib_tools/health/rig_snapshot.h"

namespace vantage {

/// One instant of every rig, from its folder or live from the running stage; a rig's calibration is
/// its folder's calibration.yaml or, live, the file named itself. A rig that works with another
/// calibration than that is warned of. Throws Error for what cannot be read and rigs that do not
/// answer.
std::vector<RigSnapshot> take_snapshots(const std::vector<RigFolder>& rigs, const LiveOption& live,
                                        long long instant);

}  // namespace vantage
