#pragma once

#include <string>

#include "host_app/session/report/live_report.h"

namespace vantage {

/// How a show stands in OpenMetrics 1.0 text, which Prometheus reads: what `--json` says of ticks,
/// instants, latencies, rigs, outputs, takes and control. Times in seconds, names begin with
/// vantage_.
std::string to_open_metrics(const LiveReport& report);

}  // namespace vantage
