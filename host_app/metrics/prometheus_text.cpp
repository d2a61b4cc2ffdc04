#include "host_app/metrics/prometheus_text.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>

#include <fmt/format.h>

namespace vantage {

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
