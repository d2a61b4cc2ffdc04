#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <zmq.hpp>

#include "common/base/time/time.h"
#include "common/pairing/pairing.h"

namespace vantage {

/// One attempt of this host to pair with a rig that is open for it.
class PairingCall {
  public:
    /// How long the rig's program may take, and both persons.
    struct Limits {
        std::chrono::nanoseconds answer_in = std::chrono::seconds(5);
        std::chrono::nanoseconds compare_in = std::chrono::minutes(2);
    };

    /// Calls the rig. `name`: of this host. Throws Error if the endpoint is none.
    PairingCall(const std::string& endpoint, const CurveKeys& keys, const std::string& name,
                const Limits& limits);

    /// To be polled.
    zmq::socket_t& socket() { return socket_; }
    /// Takes in what has come, and looks at the time. Throws Error for what ends the attempt.
    void turn(MonotonicTime now);

    /// What the person here is to compare now; nothing: not known, or answered already.
    std::optional<std::string> to_compare() const;
    const PairOffer& rig() const { return pairing_.rig(); }
    /// He has found both the same.
    void confirm();
    /// Tells the rig that this attempt is over, and why.
    void refuse(const std::string& why) { send(PairRefusal{why}); }
    /// Both have confirmed.
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
