#pragma once

#include <vector>

#include "host_app/desk/desk_state.h"
#include "host_app/session/report/live_report.h"

namespace vantage {

/// What the summary says at the end, while it runs: ticks, times in milliseconds, instants and
/// levels of quality. What was not measured is left out.
std::vector<DeskFigure> desk_figures(const LiveReport& report);

}  // namespace vantage
