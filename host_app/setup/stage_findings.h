#pragma once

#include <string>
#include <vector>

#include "common/receive/rig_status.h"

namespace vantage {

/// What a rig of the stage lacks.
struct Finding {
    std::string rig;
    bool blocks = false;  ///< the rig gives the stage nothing as long as it is so
    std::string what;
    std::string mend;  ///< what to do about it, where `what` does not say
};

/// By rig, in the stage's order. `stage_file`: for commands that are named.
std::vector<Finding> findings_of(const ReceiverStatus& status, const std::string& stage_file);

}  // namespace vantage
