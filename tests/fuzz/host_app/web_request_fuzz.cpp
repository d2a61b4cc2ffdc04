#include <cstdint>
#include <cstdlib>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <sys/socket.h>

#include "common/base/files/unique_fd.h"
#include "common/config/socket_address.h"
#include "host_app/web/web_server.h"

namespace {

using namespace vantage;

constexpr const char* secret = "the state of the show";

void require(bool is_right) {
    if (!is_right) std::abort();
}

/// Takes the text up to the next end of line.
std::string next_line(std::string_view& rest) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    std::string line(rest.substr(0, end));
    rest.remove_prefix(std::min(end + 1, rest.size()));
    return line;
}

/// A request in lines: method, path, host, cookie, name and value of a query, and the body; the
/// method ends with '!' if the request has the header of the page.
WebRequest request_of(std::string_view text) {
    WebRequest request{.method = next_line(text), .path = next_line(text)};
    if (request.method.ends_with('!')) {
        request.method.pop_back();
        request.is_from_page = true;
    }
    request.host = next_line(text);
    request.cookie = next_line(text);
    const std::string name = next_line(text);
    request.query[name] = next_line(text);
    request.body = text;
    return request;
}

void check_answer(const WebAnswer& answer) {
    require(answer.status >= 200 && answer.status < 500);
    for (const auto& [name, value] : answer.headers)
        require(value.find_first_of("\r\n") == std::string::npos);
}

/// A host for everybody on this computer, and one that asks for a PIN.
struct Desks {
    OperatorInputBox input;
    WebDesk open{{.has_control = true}, input};
    WebDesk reader{{}, input};
    WebDesk closed{{.has_control = true, .pin = "471101", .is_local = false, .is_secure = true},
                   input};
    MonotonicTime now = MonotonicClock::now();

    Desks() {
        for (WebDesk* desk : {&open, &reader, &closed})
            desk->show({.picture = ColourImage(12, 16), .set = {}, .state = secret});
    }
    void ask(const WebRequest& request) {
        now += std::chrono::milliseconds(3);
        const WebAnswer answer = open.answer(request, now);
        check_answer(answer);
        if (!is_loopback_host(request.host)) require(answer.status == 403);
        (void)input.take();
        check_answer(reader.answer(request, now));
        require(input.take().input.commands.empty());
        const WebAnswer refused = closed.answer(request, now);
        check_answer(refused);
        require(refused.body.find(secret) == std::string::npos);
        require(input.take().input.commands.empty());
    }
};

/// Sends bytes to a server as a caller who then leaves, and reads its answer.
class Caller {
  public:
    Caller() : server_(listening(), input_) {}

    void send(std::span<const std::uint8_t> bytes) {
        const SocketAddress to = resolve_all("127.0.0.1", port_, "the server").front();
        const UniqueFd fd(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
        require(::connect(fd.get(), to.get(), to.size) == 0);
        (void)::send(fd.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL);
        ::shutdown(fd.get(), SHUT_WR);
        char answer[4096];
        bool is_first = true;
        for (ssize_t got = 0; (got = ::recv(fd.get(), answer, sizeof answer, 0)) > 0;)
            if (std::exchange(is_first, false))
                require(std::string_view(answer, static_cast<std::size_t>(got))
                            .starts_with(std::string_view("HTTP/1.").substr(
                                0, static_cast<std::size_t>(got))));
        (void)input_.take();
    }

  private:
    /// The URL of a port that nobody has.
    std::string listening() {
        const UniqueFd fd(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
        sockaddr_in any{};
        any.sin_family = AF_INET;
        any.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        socklen_t size = sizeof any;
        require(::bind(fd.get(), reinterpret_cast<sockaddr*>(&any), size) == 0);
        require(::getsockname(fd.get(), reinterpret_cast<sockaddr*>(&any), &size) == 0);
        port_ = ntohs(any.sin_port);
        return fmt::format("http://127.0.0.1:{}?control=yes&pin=471101", port_);
    }
    int port_ = 0;
    OperatorInputBox input_;
    WebServer server_;
};

}  // namespace

/// The first byte says how the others are taken: as a request in lines, or as the bytes of a
/// connection.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size == 0) return 0;
    const std::span rest(data + 1, size - 1);
    if (data[0] == 'C') {
        static Caller caller;
        caller.send(rest);
    } else {
        static Desks desks;
        desks.ask(request_of({reinterpret_cast<const char*>(rest.data()), rest.size()}));
    }
    return 0;
}
