#include "host_app/metrics/metrics_server.h"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstdlib>
#include <string>
#include <string_view>

#include <fmt/format.h>
#include <microhttpd.h>

#include "common/base/error.h"
#include "common/config/socket_address.h"
#include "host_app/control/ports/control_port.h"

namespace vantage {
namespace {

/// Converts OpenMetrics text to Prometheus's own text format (0.0.4), which has no `# EOF` and
/// names families of counters and facts as their samples are named.
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

/// Whether the Accept header of an HTTP request prefers text/plain to OpenMetrics.
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

constexpr unsigned most_peers = 8, patience_s = 10;
constexpr std::size_t bytes_a_peer = 16384;
constexpr const char* metrics_type = "application/openmetrics-text; version=1.0.0; charset=utf-8";
constexpr const char* prometheus_type = "text/plain; version=0.0.4; charset=utf-8";

MHD_Result answer_with(MHD_Connection* connection, unsigned status, std::string_view body,
                       const char* type) {
    MHD_Response* response = MHD_create_response_from_buffer(
        body.size(), const_cast<char*>(body.data()), MHD_RESPMEM_MUST_COPY);
    if (!response) return MHD_NO;
    MHD_add_response_header(response, MHD_HTTP_HEADER_CONTENT_TYPE, type);
    const MHD_Result result = MHD_queue_response(connection, status, response);
    MHD_destroy_response(response);
    return result;
}

MHD_Result answer(void* server, MHD_Connection* connection, const char* path, const char* method,
                  const char*, const char*, std::size_t* body_bytes, void**) {
    constexpr const char* plain = "text/plain";
    if (*body_bytes != 0) return MHD_NO;
    if (std::string_view(method) != MHD_HTTP_METHOD_GET &&
        std::string_view(method) != MHD_HTTP_METHOD_HEAD)
        return answer_with(connection, MHD_HTTP_METHOD_NOT_ALLOWED, "only GET\n", plain);
    if (std::string_view(path) != "/metrics")
        return answer_with(connection, MHD_HTTP_NOT_FOUND, "there is only /metrics\n", plain);
    const auto text = static_cast<const MetricsServer*>(server)->shown();
    const char* accept =
        MHD_lookup_connection_value(connection, MHD_HEADER_KIND, MHD_HTTP_HEADER_ACCEPT);
    if (prefers_prometheus_text(accept ? accept : ""))
        return answer_with(connection, MHD_HTTP_OK, to_prometheus_text(*text), prometheus_type);
    return answer_with(connection, MHD_HTTP_OK, *text, metrics_type);
}

}  // namespace

void MetricsServer::Stop::operator()(MHD_Daemon* daemon) const { MHD_stop_daemon(daemon); }

MetricsServer::MetricsServer(const std::string& text)
    : text_(std::make_shared<const std::string>("# EOF\n")) {
    const OutputUrl url = OutputUrl::parse(text, "metrics");
    if (url.scheme != "http") fail("the metrics address {} is not http://HOST:PORT", url.shown);
    const NetworkPlace place = listening_place_of(url);
    url.require_options_of({"open"});
    const std::string what = "metrics " + url.shown;
    std::vector<ListenAttempt> attempts;
    for (const SocketAddress& address : resolve_all(place.host, place.port, what)) {
        const unsigned flags = MHD_USE_INTERNAL_POLLING_THREAD |
                               (address.family() != AF_INET6 ? MHD_NO_FLAG
                                : address.is_any()           ? MHD_USE_IPv6 | MHD_USE_DUAL_STACK
                                                             : MHD_USE_IPv6);
        errno = 0;
        std::unique_ptr<MHD_Daemon, Stop> daemon(MHD_start_daemon(
            flags, 0, nullptr, nullptr, answer, this, MHD_OPTION_SOCK_ADDR, &address.bytes,
            MHD_OPTION_CONNECTION_LIMIT, most_peers, MHD_OPTION_CONNECTION_TIMEOUT, patience_s,
            MHD_OPTION_CONNECTION_MEMORY_LIMIT, bytes_a_peer, MHD_OPTION_END));
        attempts.push_back({address, daemon ? 0 : errno != 0 ? errno : EADDRINUSE});
        if (daemon) daemons_.push_back(std::move(daemon));
    }
    check_attempts(attempts, what);
}

MetricsServer::~MetricsServer() = default;

void MetricsServer::show(std::string text) {
    auto next = std::make_shared<const std::string>(std::move(text));
    const std::lock_guard lock(mutex_);
    text_ = std::move(next);
}

std::shared_ptr<const std::string> MetricsServer::shown() const {
    const std::lock_guard lock(mutex_);
    return text_;
}

}  // namespace vantage
