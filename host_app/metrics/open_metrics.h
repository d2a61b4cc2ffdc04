#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>

#include "common/base/percentiles.h"
#include "host_app/session/report/live_report.h"

namespace vantage {

/// Formats the state of a show as OpenMetrics 1.0 text for Prometheus: what `--json` reports of
/// ticks, instants, latencies, rigs, outputs, takes and control. Times are in seconds, names begin
/// with vantage_.
std::string to_open_metrics(const LiveReport& report);

/// Writes OpenMetrics text: each family of metrics, followed by its samples.
class MetricText {
  public:
    using Labels = std::initializer_list<std::pair<std::string_view, std::string_view>>;

    /// `name` is without the suffix of the kind (_total, _info).
    void gauge(std::string_view name, std::string_view help) { family(name, "gauge", help); }
    void counter(std::string_view name, std::string_view help) { family(name, "counter", help); }
    void summary(std::string_view name, std::string_view help) { family(name, "summary", help); }
    void info(std::string_view name, std::string_view help) { family(name, "info", help); }

    /// Adds a sample to the last family.
    void sample(double value, Labels labels = {});
    /// Adds the quantiles in seconds and the count of a summary; nothing if there are no samples.
    void percentiles(const Percentiles& ms, Labels labels = {});

    /// The whole text with its end marker.
    std::string whole() const { return text_ + "# EOF\n"; }

  private:
    void family(std::string_view name, std::string_view kind, std::string_view help);
    void line(std::string_view ending, double value, Labels labels, std::string_view quantile = "");

    std::string text_, name_, kind_;
};

}  // namespace vantage
