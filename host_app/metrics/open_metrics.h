#pragma once

#include <string>

#include "host_app/session/report/live_report.h"

namespace vantage {

/// Formats the state of a show as OpenMetrics 1.0 text for Prometheus: what `--json` reports of
/// ticks, instants, latencies, rigs, outputs, takes and control. Times are in seconds, names begin
/// with vantage_.
std::string to_open_metrics(const LiveReport& report);

}  // namespace vantage
