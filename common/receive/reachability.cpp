#include "common/receive/reachability.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <vector>

#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>

#include "common/base/error.h"
#include "common/base/files/unique_fd.h"
#include "common/config/socket_address.h"

namespace vantage {
namespace {

/// Tries to connect to an address. Returns 0, or errno.
int try_address(const SocketAddress& address, std::chrono::milliseconds limit) {
    const UniqueFd fd(::socket(address.family(), SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
    if (!fd) return errno;
    if (::connect(fd.get(), address.get(), address.size) == 0) return 0;
    if (errno != EINPROGRESS) return errno;
    pollfd wait{fd.get(), POLLOUT, 0};
    if (::poll(&wait, 1, static_cast<int>(limit.count())) <= 0) return ETIMEDOUT;
    int error = 0;
    socklen_t size = sizeof error;
    ::getsockopt(fd.get(), SOL_SOCKET, SO_ERROR, &error, &size);
    return error;
}

/// The endpoint, and in brackets the addresses of its name.
std::string words_of(const Endpoint& endpoint, const std::vector<ListenAttempt>& attempts) {
    std::string words;
    for (const ListenAttempt& attempt : attempts)
        words += (words.empty() ? "" : ", ") + attempt.address.host();
    return words == endpoint.host ? endpoint.text()
                                  : fmt::format("{} ({})", endpoint.text(), words);
}

std::string reason_of(const Endpoint& endpoint, const std::vector<ListenAttempt>& attempts) {
    const auto all_failed_with = [&](int error) {
        return std::all_of(attempts.begin(), attempts.end(),
                           [&](const ListenAttempt& attempt) { return attempt.error == error; });
    };
    if (all_failed_with(ECONNREFUSED))
        return fmt::format(
            "connection refused at {}: the computer is up, but vantage-rig does not run "
            "there, or uses another port",
            words_of(endpoint, attempts));
    if (all_failed_with(ETIMEDOUT))
        return fmt::format(
            "nothing answers at {}: check that its computer is on, that the cable is plugged in "
            "and that the firewall lets the port through",
            words_of(endpoint, attempts));
    std::string failures;
    for (const ListenAttempt& attempt : attempts)
        failures += fmt::format("{}{}: {}", failures.empty() ? "" : ", ", attempt.address.host(),
                                std::strerror(attempt.error));
    return fmt::format("{} cannot be reached ({})", endpoint.text(), failures);
}

}  // namespace

Reachability reach(const Endpoint& endpoint, std::chrono::milliseconds limit) {
    std::vector<ListenAttempt> attempts;
    try {
        for (const SocketAddress& address : resolve_all(endpoint.host, std::stoi(endpoint.port))) {
            attempts.push_back({address, try_address(address, limit)});
            if (attempts.back().error == 0) return {"tcp://" + address.text(), ""};
        }
    } catch (const Error& error) {
        return {"", error.what()};
    }
    return {"", reason_of(endpoint, attempts)};
}

}  // namespace vantage
