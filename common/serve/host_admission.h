#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <zmq.hpp>

#include "common/base/log_limiter.h"
#include "common/base/time/time.h"

namespace vantage {

/// Says which host keys are let in: answers the authentication requests (ZAP, ZeroMQ RFC 27) of the
/// sockets of one context. Lives on one thread, which polls socket() and calls answer().
class HostAdmission {
  public:
    /// Throws Error if the list cannot be read. It is read again when it changes; hosts that are
    /// connected stay so.
    HostAdmission(zmq::context_t& context, std::filesystem::path authorized_hosts);

    zmq::socket_t& socket() { return socket_; }

    /// Answers one request, if one is there. Refused keys are logged, a few by name and once in a
    /// while.
    void answer();

  private:
    void read_list_if_changed();
    bool admits(const std::string& key, const std::string& address);

    std::filesystem::path path_;
    std::filesystem::file_time_type read_version_;
    std::map<std::string, std::string> hosts_;
    zmq::socket_t socket_;
    std::map<std::string, MonotonicTime> told_;  ///< of which keys, and when: a few
    LogLimiter others_;
};

}  // namespace vantage
