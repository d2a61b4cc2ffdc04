#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <zmq.hpp>

#include "common/base/log_limiter.h"
#include "common/base/time/time.h"

namespace vantage {

/// Authenticates hosts by their keys: answers the ZAP requests (ZeroMQ RFC 27) of the sockets of
/// one context. Used by one thread, which polls socket() and calls answer().
class HostAdmission {
  public:
    /// Throws Error if the list cannot be read. A changed list is read again.
    HostAdmission(zmq::context_t& context, std::filesystem::path authorized_hosts);

    zmq::socket_t& socket() { return socket_; }

    /// Answers one waiting request. Logs refused keys, within limits.
    void answer();

    /// Whether the list has the key of a connected host, which may have been removed meanwhile.
    bool lists(const std::string& key);
    const std::filesystem::path& path() const { return path_; }

  private:
    void read_list_if_changed();
    bool admits(const std::string& key, const std::string& address);

    std::filesystem::path path_;
    std::filesystem::file_time_type read_version_;
    std::map<std::string, std::string> hosts_;
    zmq::socket_t socket_;
    std::map<std::string, MonotonicTime> told_;  ///< when each logged key was logged
    LogLimiter others_;
};

}  // namespace vantage
