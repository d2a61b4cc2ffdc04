#include "rig_firmware/daemon/service_notifier.h"

#include <cstdlib>
#include <cstring>

#include <sys/socket.h>
#include <sys/un.h>

#include "common/base/files/unique_fd.h"

namespace vantage {
namespace {

std::string environment(const char* name) {
    const char* value = std::getenv(name);
    return value ? value : "";
}

/// Half of the watchdog's timeout; without a watchdog, a status line every few seconds.
std::chrono::nanoseconds notify_period() {
    const std::string limit_us = environment("WATCHDOG_USEC");
    constexpr std::chrono::seconds without_watchdog(5);
    const long long us = std::strtoll(limit_us.c_str(), nullptr, 10);
    if (us <= 0) return without_watchdog;
    return std::chrono::microseconds(us) / 2;
}

}  // namespace

ServiceNotifier::ServiceNotifier()
    : socket_(environment("NOTIFY_SOCKET")), period_(notify_period()) {}

void ServiceNotifier::ready() { send("READY=1"); }
void ServiceNotifier::stopping() { send("STOPPING=1"); }

void ServiceNotifier::alive(const std::string& status) {
    send_seldom("WATCHDOG=1\nSTATUS=" + status);
}

void ServiceNotifier::stuck(const std::string& status) { send_seldom("STATUS=" + status); }

void ServiceNotifier::send_seldom(const std::string& message) {
    const auto now = std::chrono::steady_clock::now();
    if (last_ && now - *last_ < period_) return;
    last_ = now;
    send(message);
}

void ServiceNotifier::send(const std::string& message) const {
    sockaddr_un address{};
    if (socket_.empty() || socket_.size() >= sizeof address.sun_path) return;
    address.sun_family = AF_UNIX;
    std::memcpy(address.sun_path, socket_.data(), socket_.size());
    if (socket_[0] == '@') address.sun_path[0] = '\0';  // abstract socket
    const UniqueFd fd(::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0));
    const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + socket_.size());
    ::sendto(fd.get(), message.data(), message.size(), MSG_NOSIGNAL,
             reinterpret_cast<const sockaddr*>(&address), size);
}

}  // namespace vantage
