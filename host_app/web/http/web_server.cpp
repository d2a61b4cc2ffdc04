#include "host_app/web/web_server.h"

#include <cerrno>
#include <string_view>

#include <fmt/format.h>
#include <microhttpd.h>

#include "common/base/error.h"
#include "common/base/files/atomic_file.h"
#include "common/base/files/folder.h"
#include "common/base/log.h"
#include "common/config/socket_address.h"
#include "common/wire/random_id.h"
#include "host_app/control/ports/control_port.h"

namespace vantage {
namespace {

constexpr unsigned most_connections = 100, silence_s = 20;
constexpr std::size_t bytes_per_connection = 32768;

/// The body of a request while it arrives.
struct Arriving {
    std::string body;
    bool is_too_long = false;
};

std::string header(MHD_Connection* connection, const char* name) {
    const char* value = MHD_lookup_connection_value(connection, MHD_HEADER_KIND, name);
    return value ? value : "";
}

MHD_Result collect_query(void* request, MHD_ValueKind, const char* name, const char* value) {
    static_cast<WebRequest*>(request)->query[name] = value ? value : "";
    return MHD_YES;
}

MHD_Result send_web_answer(MHD_Connection* connection, const WebAnswer& answer) {
    MHD_Response* response = MHD_create_response_from_buffer(
        answer.body.size(), const_cast<char*>(answer.body.data()), MHD_RESPMEM_MUST_COPY);
    if (!response) return MHD_NO;
    MHD_add_response_header(response, MHD_HTTP_HEADER_CONTENT_TYPE, answer.type.c_str());
    for (const auto& [name, value] : answer.headers)
        MHD_add_response_header(response, name.c_str(), value.c_str());
    const MHD_Result result = MHD_queue_response(connection, answer.status, response);
    MHD_destroy_response(response);
    return result;
}

MHD_Result answer_web(void* desk, MHD_Connection* connection, const char* path, const char* method,
                      const char*, const char* body, std::size_t* body_bytes, void** state) {
    if (!*state) {
        *state = new Arriving;
        return MHD_YES;
    }
    auto& arriving = *static_cast<Arriving*>(*state);
    if (*body_bytes > 0) {
        arriving.is_too_long = arriving.body.size() + *body_bytes > most_web_body_bytes;
        if (arriving.is_too_long) return MHD_NO;
        arriving.body.append(body, *body_bytes);
        *body_bytes = 0;
        return MHD_YES;
    }
    WebRequest request{.method = method, .path = path};
    request.host = header(connection, MHD_HTTP_HEADER_HOST);
    request.is_from_page = !header(connection, "X-Vantage").empty();
    request.body = arriving.body;
    if (const char* cookie = MHD_lookup_connection_value(connection, MHD_COOKIE_KIND, "vantage"))
        request.cookie = cookie;
    MHD_get_connection_values(connection, MHD_GET_ARGUMENT_KIND, collect_query, &request);
    return send_web_answer(connection,
                           static_cast<WebDesk*>(desk)->answer(request, MonotonicClock::now()));
}

void end_web_request(void*, MHD_Connection*, void** state, MHD_RequestTerminationCode) {
    delete static_cast<Arriving*>(*state);
    *state = nullptr;
}

std::string pin_of(const OutputUrl& url, bool is_local) {
    constexpr std::size_t least = 4, most = 64;
    std::string pin;
    if (const auto file = url.option("pin-file")) {
        pin = read_text_file(*file, most + 2);
        while (!pin.empty() && (pin.back() == '\n' || pin.back() == '\r')) pin.pop_back();
    } else if (const auto given = url.option("pin")) {
        pin = *given;
    } else if (!is_local) {
        constexpr std::uint64_t million = 1'000'000;
        pin = fmt::format("{:06}", random_id() % million);
        log_info("web {}: the page asks for the PIN {}", url.shown, pin);
        return pin;
    } else {
        return "";
    }
    if (pin.size() < least || pin.size() > most)
        fail("the PIN of the page has {} characters; it has to have {} to {}", pin.size(), least,
             most);
    return pin;
}

OutputUrl parsed_web_url(const std::string& text) {
    OutputUrl url = OutputUrl::parse(text, "web");
    if (url.scheme != "http" && url.scheme != "https")
        fail("the web address {} is not http://HOST:PORT or https://HOST:PORT", url.shown);
    url.require_options_of({"open", "control", "pin", "pin-file", "certificate", "key", "board"});
    if (const auto pin = url.option("pin")) {
        const std::size_t at = url.shown.find("pin=");
        url.shown.replace(at, 4 + pin->size(), "pin=***");
    }
    (void)url.choice("control", {"no", "yes"});
    if (url.option("certificate").has_value() != url.option("key").has_value())
        fail("the web address {} needs both certificate=FILE and key=FILE", url.shown);
    if (url.scheme == "http" && url.option("certificate"))
        fail("the web address {} has a certificate, which only https:// uses", url.shown);
    return url;
}

std::optional<CalibrationBoards> boards_of(const OutputUrl& url) {
    if (const auto board = url.option("board")) return boards_of_option(*board);
    return std::nullopt;
}

NetworkPlace web_place_of(const OutputUrl& url) {
    NetworkPlace place = listening_place_of(url);
    if (!place.is_loopback && url.scheme != "https")
        fail("the web address {} is open beyond this computer and not encrypted: say https://",
             url.shown);
    return place;
}

}  // namespace

void WebServer::Stop::operator()(MHD_Daemon* daemon) const { MHD_stop_daemon(daemon); }

void require_web_url(const std::string& text) {
    const OutputUrl url = parsed_web_url(text);
    (void)web_place_of(url);
    (void)boards_of(url);
}

WebServer::WebServer(const std::string& text, OperatorInputBox& input) {
    const OutputUrl url = parsed_web_url(text);
    const NetworkPlace place = web_place_of(url);
    const bool is_secure = url.scheme == "https";
    if (is_secure) {
        const auto file = url.option("certificate");
        certificate_ =
            file ? read_certificate(*file, *url.option("key")) : own_certificate(user_folder());
        if (!file)
            log_info("web {}: the certificate signs itself; its SHA-256 is {}", url.shown,
                     certificate_->fingerprint);
    }
    desk_ = std::make_unique<WebDesk>(
        WebDesk::Settings{.has_control = url.choice("control", {"no", "yes"}) == "yes",
                          .pin = pin_of(url, place.is_loopback),
                          .is_local = place.is_loopback,
                          .is_secure = is_secure,
                          .boards = boards_of(url)},
        input);
    const std::string what = "web " + url.shown;
    std::vector<ListenAttempt> attempts;
    for (const SocketAddress& address : resolve_all(place.host, place.port, what)) {
        const unsigned flags = MHD_USE_INTERNAL_POLLING_THREAD |
                               (is_secure ? MHD_USE_TLS : MHD_NO_FLAG) |
                               (address.family() != AF_INET6 ? MHD_NO_FLAG
                                : address.is_any()           ? MHD_USE_IPv6 | MHD_USE_DUAL_STACK
                                                             : MHD_USE_IPv6);
        std::vector<MHD_OptionItem> secrets;
        if (is_secure) {
            secrets.push_back({MHD_OPTION_HTTPS_MEM_CERT, 0, certificate_->certificate.data()});
            secrets.push_back({MHD_OPTION_HTTPS_MEM_KEY, 0, certificate_->key.data()});
        }
        secrets.push_back({MHD_OPTION_END, 0, nullptr});
        errno = 0;
        std::unique_ptr<MHD_Daemon, Stop> daemon(MHD_start_daemon(
            flags, 0, nullptr, nullptr, answer_web, desk_.get(), MHD_OPTION_SOCK_ADDR,
            &address.bytes, MHD_OPTION_CONNECTION_LIMIT, most_connections,
            MHD_OPTION_CONNECTION_TIMEOUT, silence_s, MHD_OPTION_CONNECTION_MEMORY_LIMIT,
            bytes_per_connection, MHD_OPTION_NOTIFY_COMPLETED, end_web_request, nullptr,
            MHD_OPTION_ARRAY, secrets.data(), MHD_OPTION_END));
        attempts.push_back({address, daemon ? 0 : errno != 0 ? errno : EADDRINUSE});
        if (daemon) daemons_.push_back(std::move(daemon));
    }
    check_attempts(attempts, what);
}

WebServer::~WebServer() = default;

}  // namespace vantage
