#include "host_app/metrics/metric_text.h"

#include <fmt/format.h>

namespace vantage {
namespace {

constexpr double ms_per_s = 1000;

std::string escaped(std::string_view text) {
    std::string safe;
    for (const char c : text) {
        if (c == '\n') {
            safe += "\\n";
            continue;
        }
        if (c == '"' || c == '\\') safe += '\\';
        safe += c;
    }
    return safe;
}

}  // namespace

void MetricText::family(std::string_view name, std::string_view kind, std::string_view help) {
    name_ = fmt::format("vantage_{}", name);
    kind_ = kind;
    text_ += fmt::format("# TYPE {} {}\n# HELP {} {}\n", name_, kind_, name_, escaped(help));
}

void MetricText::line(std::string_view ending, double value, Labels labels,
                      std::string_view quantile) {
    std::string inside;
    const auto add = [&](std::string_view name, std::string_view label) {
        inside += fmt::format("{}{}=\"{}\"", inside.empty() ? "" : ",", name, escaped(label));
    };
    for (const auto& [name, label] : labels) add(name, label);
    if (!quantile.empty()) add("quantile", quantile);
    text_ += fmt::format("{}{}{} {}\n", name_, ending,
                         inside.empty() ? "" : fmt::format("{{{}}}", inside), value);
}

void MetricText::sample(double value, Labels labels) {
    line(kind_ == "counter" ? "_total" : kind_ == "info" ? "_info" : "", value, labels);
}

void MetricText::percentiles(const Percentiles& ms, Labels labels) {
    if (ms.count == 0) return;
    for (const auto& [quantile, value] :
         {std::pair("0.5", ms.p50), {"0.95", ms.p95}, {"0.99", ms.p99}, {"1", ms.max}})
        line("", value / ms_per_s, labels, quantile);
    line("_count", static_cast<double>(ms.count), labels);
}

}  // namespace vantage
