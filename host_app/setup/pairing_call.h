#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <zmq.hpp>

#include "common/base/time/time.h"
#include "common/pairing/pairing.h"

namespace vantage {

/// One attempt of this host to pair with a rig that is open for pairing. Not thread-safe.
class PairingCall {
  public:
    /// How long the rig's program and both persons may take.
    struct Limits {
        std::chrono::nanoseconds answer_in = std::chrono::seconds(5);
        std::chrono::nanoseconds compare_in = std::chrono::minutes(2);
    };

    /// Connects to the rig. `name`: of this host. Throws Error for an invalid endpoint.
    PairingCall(const std::string& endpoint, const CurveKeys& keys, const std::string& name,
                const Limits& limits);

    /// The socket to poll.
    zmq::socket_t& socket() { return socket_; }
    /// Handles messages and time limits. Throws Error for a fault that ends the attempt.
    void turn(MonotonicTime now);

    /// The code that the person at this host is to compare now; empty if unknown or answered.
    std::optional<std::string> to_compare() const;
    const PairOffer& rig() const { return pairing_.rig(); }
    /// Confirms that both codes are the same.
    void confirm();
    /// Ends the attempt and tells the rig why.
    void refuse(const std::string& why) { send(PairRefusal{why}); }
    /// Whether both ends have confirmed.
    bool is_agreed() const { return pairing_.is_agreed(); }

  private:
    void send(const PairMessage& message);

    std::string endpoint_;
    Limits limits_;
    HostPairing pairing_;
    MonotonicTime end_;
    zmq::context_t context_;
    zmq::socket_t socket_;
};

}  // namespace vantage
