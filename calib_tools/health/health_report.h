#pragma once

#include <nlohmann/json.hpp>

#include "calib_tools/health/health_history.h"
#include "calib_tools/health/stage_health.h"
#include "calib_tools/plots/html_page.h"

namespace vantage {

nlohmann::json to_json(const StageHealth& health, const std::string& date);

/// Report for a terminal: one line per measure, then the advice.
std::string describe(const StageHealth& health);

/// Report as a page: verdicts with units, limits and history; the stage from above; row errors of
/// every rig.
HtmlPage health_page(const StageHealth& health, const std::vector<RigSnapshot>& rigs,
                     const std::vector<PastCheck>& past, const std::string& date);

}  // namespace vantage
