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

/// Logs and counts connections to a listening socket that end before they are a host's. Strangers
/// may come in floods: of each kind a line is written once in a while, with how many it stands for.
/// Lives on the socket's thread, which polls socket() and calls look().
class StrangerWatch {
  public:
    /// The socket has to close a connection whose handshake takes longer.
    static constexpr std::chrono::seconds handshake_limit{5};

    /// To be made before the socket is bound, and to go before it does. Throws Error if the socket
    /// cannot be watched.
    StrangerWatch(zmq::context_t& context, zmq::socket_t& watched, std::string rig);
    ~StrangerWatch();
    StrangerWatch(const StrangerWatch&) = delete;
    StrangerWatch& operator=(const StrangerWatch&) = delete;

    zmq::socket_t& socket() { return events_; }

    /// Whether hosts have to show a key, which decides what strangers are told apart by.
    void expect_keys() { has_keys_ = true; }
    /// A message came by this connection, so it is a host's.
    void hear(zmq::message_t& part);
    /// Takes in what has happened, and writes the lines that are due. Never waits.
    void look(MonotonicTime now);

    /// Connections so far that came to nothing.
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
    std::map<int, Connection> open_;   ///< by file descriptor: no more than the process may have
    std::optional<Kind> failed_;       ///< a handshake did, and its connection is about to end
    std::uint64_t unheard_hosts_ = 0;  ///< connections of hosts that have not said a word yet
    std::uint64_t unlisted_ = 0;       ///< those whose key was refused and that have not ended yet
    std::array<Complaint, static_cast<std::size_t>(Kind::count)> complaints_;
    std::uint64_t refused_ = 0;
};

}  // namespace vantage
