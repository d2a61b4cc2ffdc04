#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <zmq.hpp>

#include "common/base/log_limiter.h"
#include "common/base/time/time.h"

namespace vantage {

/// Logs and counts connections to a listening socket that end before they turn out to be a host's,
/// and ends those of hosts that are not admitted any more. Each kind is logged once in a while,
/// with its count. Used by the socket's thread, which polls socket() and calls look().
class StrangerWatch {
  public:
    /// The socket has to close a connection whose handshake takes longer.
    static constexpr std::chrono::seconds handshake_limit{5};

    /// Construct it before the socket is bound, and destroy it before the socket. Throws Error if
    /// the socket cannot be monitored.
    StrangerWatch(zmq::context_t& context, zmq::socket_t& watched, std::string rig);
    ~StrangerWatch();
    StrangerWatch(const StrangerWatch&) = delete;
    StrangerWatch& operator=(const StrangerWatch&) = delete;

    zmq::socket_t& socket() { return events_; }

    /// Sets that hosts need a key, which changes how connections are classified.
    void expect_keys() { has_keys_ = true; }
    /// Takes in a message; its connection is a host's.
    void hear(zmq::message_t& part);
    /// Ends the connection that a message came over. ZeroMQ has no call for that: its socket is
    /// shut down in both directions, and ZeroMQ then closes it as if the other end had left. Does
    /// nothing if the connection has ended meanwhile.
    void disconnect(zmq::message_t& part) const;
    /// Handles waiting events and logs lines that are due. Never waits.
    void look(MonotonicTime now);

    /// Number of refused connections so far.
    std::uint64_t refused() const { return refused_; }

  private:
    enum class Kind { silent, left, foreign, keyless, forged, count };
    struct Connection {
        std::string address;
        MonotonicTime since{};
        bool is_heard = false;
    };
    struct Complaint {
        LogLimiter limiter{std::chrono::seconds(10)};
        std::uint64_t fresh = 0;
        std::string address;
    };

    void take_in(std::uint16_t event, std::uint32_t value, MonotonicTime now);
    void end(int descriptor, MonotonicTime now);
    std::string reason(Kind kind) const;

    const std::string rig_;
    zmq::socket_t& watched_;
    zmq::socket_t events_;
    bool has_keys_ = false;
    std::map<int, Connection> open_;   ///< by file descriptor, so the size is bounded
    std::optional<Kind> failed_;       ///< a handshake failed, and its connection is about to end
    std::uint64_t unheard_hosts_ = 0;  ///< connections of hosts without a message yet
    std::uint64_t unlisted_ = 0;       ///< connections with a refused key that have not ended yet
    std::array<Complaint, static_cast<std::size_t>(Kind::count)> complaints_;
    std::uint64_t refused_ = 0;
};

}  // namespace vantage
