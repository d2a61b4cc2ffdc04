#pragma once

#include <chrono>
#include <optional>
#include <string>

namespace vantage {

/// Reports readiness, status and signs of life to the service manager by sd_notify's protocol on
/// $NOTIFY_SOCKET. The signs of life feed systemd's watchdog. Does nothing if no service manager
/// started the program.
class ServiceNotifier {
  public:
    ServiceNotifier();

    void ready();
    void stopping();
    /// Sends a sign of life and the status line once half of the watchdog's timeout has passed.
    /// Call it often.
    void alive(const std::string& status);
    /// Sends the status line without a sign of life, so that the watchdog restarts the program.
    /// Call it instead of alive() while a part of the program is stuck.
    void stuck(const std::string& status);

  private:
    void send(const std::string& message) const;
    void send_seldom(const std::string& message);

    std::string socket_;
    std::chrono::nanoseconds period_;
    std::optional<std::chrono::steady_clock::time_point> last_;
};

}  // namespace vantage
