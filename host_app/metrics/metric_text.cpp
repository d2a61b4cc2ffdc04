#include "host_app/metrics/metric_text.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>

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

std::string to_prometheus_text(std::string_view open_metrics) {
    std::string text;
    std::string family, renamed;
    for (std::size_t at = 0; at < open_metrics.size();) {
        const std::size_t end = std::min(open_metrics.find('\n', at), open_metrics.size());
        const std::string line(open_metrics.substr(at, end - at));
        at = end + 1;
        constexpr std::string_view type = "# TYPE ", help = "# HELP ";
        if (line == "# EOF" || line.starts_with("# UNIT ")) continue;
        if (line.starts_with(type)) {
            const std::size_t space = line.find(' ', type.size());
            family = line.substr(type.size(), space - type.size());
            const std::string kind = line.substr(space + 1);
            renamed = family + (kind == "counter" ? "_total" : kind == "info" ? "_info" : "");
            text += fmt::format("{}{} {}\n", type, renamed, kind == "info" ? "gauge" : kind);
        } else if (line.starts_with(help) &&
                   line.compare(help.size(), family.size() + 1, family + " ") == 0) {
            text +=
                fmt::format("{}{}{}\n", help, renamed, line.substr(help.size() + family.size()));
        } else {
            text += line + '\n';
        }
    }
    return text;
}

bool prefers_prometheus_text(std::string_view accept) {
    double plain = 0, open_metrics = 0;
    for (std::size_t at = 0; at < accept.size();) {
        const std::size_t end = std::min(accept.find(',', at), accept.size());
        std::string part;
        for (const char c : accept.substr(at, end - at))
            if (c != ' ' && c != '\t')
                part += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
        at = end + 1;
        double quality = 1;
        if (const std::size_t q = part.find(";q="); q != std::string::npos)
            quality = std::atof(part.c_str() + q + 3);
        const std::string type = part.substr(0, part.find(';'));
        if (type == "text/plain" || type == "text/*") plain = std::max(plain, quality);
        if (type == "application/openmetrics-text" || type == "application/*")
            open_metrics = std::max(open_metrics, quality);
    }
    return plain > open_metrics;
}

}  // namespace vantage
