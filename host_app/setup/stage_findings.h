#pragma once

#include <string>
#include <vector>

#include "common/receive/rig_status.h"

namespace vantage {

/// A fault of a rig that `vantage setup` reports.
struct Finding {
    std::string rig;
    bool blocks = false;  ///< whether the rig contributes nothing because of it
    std::string what;
    std::string mend;  ///< the repair, unless `what` contains it
};

/// The findings by rig, in the stage's order. `stage_file`: for the commands in them.
std::vector<Finding> findings_of(const ReceiverStatus& status, const std::string& stage_file);

}  // namespace vantage
