#pragma once

#include <chrono>
#include <optional>
#include <string>

namespace vantage {

/// Tells the service manager how this program fares (sd_notify's protocol, on $NOTIFY_SOCKET): that
/// it stands, and that it is alive, by which systemd's watchdog goes. Does nothing where no service
/// manager started it.
class ServiceNotifier {
  public:
    ServiceNotifier();

    void ready();
    void stopping();
    /// To be called often: sends a sign of life and the status line whenever half the watchdog's
    /// time has passed.
    void alive(const std::string& status);
    /// In its place while a part of the program is stuck: the status line without the sign of life,
    /// so that the watchdog restarts the program.
    void stuck(const std::string& status);

  private:
    void send(const std::string& message) const;
    void send_seldom(const std::string& message);

    std::string socket_;
    std::chrono::nanoseconds period_;
    std::optional<std::chrono::steady_clock::time_point> last_;
};

}  // namespace vantage
