#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <vector>

struct MHD_Daemon;

namespace vantage {

/// Serves the last text that it was given over HTTP (GET /metrics), on a thread of its own. Accepts
/// at most eight connections at a time, and closes one that is silent for ten seconds. Thread-safe.
class MetricsServer {
  public:
    /// `url`: "http://HOST:PORT"; without a host at 127.0.0.1, beyond this computer with
    /// "?open=yes" only. Throws Error for an address that is in use or not allowed.
    explicit MetricsServer(const std::string& url);
    ~MetricsServer();
    MetricsServer(const MetricsServer&) = delete;
    MetricsServer& operator=(const MetricsServer&) = delete;

    void show(std::string text);
    std::shared_ptr<const std::string> shown() const;

  private:
    struct Stop {
        void operator()(MHD_Daemon* daemon) const;
    };
    mutable std::mutex mutex_;
    std::shared_ptr<const std::string> text_;
    std::vector<std::unique_ptr<MHD_Daemon, Stop>> daemons_;  ///< one for each address
};

}  // namespace vantage
