#pragma once

#include <optional>

#include "host_app/flight/corridor.h"

namespace vantage {

/// Where in its corridor the camera is, and was.
struct CorridorStats {
    std::optional<Coverage> now;      ///< nothing: not known yet
    double edge_s = 0, beyond_s = 0;  ///< so long it was there
    double least_share = 1;
};

}  // namespace vantage
