#pragma once

#include <string>
#include <string_view>

namespace vantage {

/// Converts OpenMetrics text to Prometheus's own text format (0.0.4), which has no `# EOF` and
/// names families of counters and facts as their samples are named.
std::string to_prometheus_text(std::string_view open_metrics);

/// Whether the Accept header of an HTTP request prefers text/plain to OpenMetrics.
bool prefers_prometheus_text(std::string_view accept);

}  // namespace vantage
