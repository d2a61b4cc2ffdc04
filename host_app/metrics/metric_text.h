#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>

#include "common/base/percentiles.h"

namespace vantage {

/// Writes OpenMetrics text: a family of metrics at a time, then its samples.
class MetricText {
  public:
    using Labels = std::initializer_list<std::pair<std::string_view, std::string_view>>;

    /// `name` without the ending that its kind gives to samples (_total, _info).
    void gauge(std::string_view name, std::string_view help) { family(name, "gauge", help); }
    void counter(std::string_view name, std::string_view help) { family(name, "counter", help); }
    void summary(std::string_view name, std::string_view help) { family(name, "summary", help); }
    void info(std::string_view name, std::string_view help) { family(name, "info", help); }

    /// Of the family that was begun last.
    void sample(double value, Labels labels = {});
    /// Of a summary: its quantiles in seconds, and how many samples there ever were. Nothing of
    /// none.
    void percentiles(const Percentiles& ms, Labels labels = {});

    /// All of it, with its end.
    std::string whole() const { return text_ + "# EOF\n"; }

  private:
    void family(std::string_view name, std::string_view kind, std::string_view help);
    void line(std::string_view ending, double value, Labels labels, std::string_view quantile = "");

    std::string text_, name_, kind_;
};

/// The same in Prometheus's own text format (0.0.4), which has no `# EOF`, and names families of
/// counters and facts as it does their samples.
std::string to_prometheus_text(std::string_view open_metrics);

/// Whether an HTTP request with this Accept header is to be answered in Prometheus's own text
/// format: it takes text/plain, and OpenMetrics less or not at all.
bool prefers_prometheus_text(std::string_view accept);

}  // namespace vantage
