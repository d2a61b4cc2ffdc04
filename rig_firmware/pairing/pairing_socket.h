#pragma once

#include <string>
#include <vector>
#include <zmq.hpp>

#include "rig_firmware/pairing/pairing_window.h"

namespace vantage {

/// The socket at which hosts pair. It carries nothing secret and trusts nothing it hears.
class PairingSocket {
  public:
    /// Throws Error if the endpoint is none or cannot be bound.
    explicit PairingSocket(const std::string& endpoint);

    zmq::socket_t& socket() { return socket_; }
    /// With the port that was bound, where the configuration left it open.
    std::string endpoint() const { return socket_.get(zmq::sockopt::last_endpoint); }
    /// Hands the window what has come, and sends what it answers. Never waits.
    void serve(PairingWindow& window, MonotonicTime now);
    void send(const std::vector<PairingWindow::Outgoing>& messages);
    /// Of the connection that was heard last, for people.
    const std::string& peer_address() const { return peer_address_; }

  private:
    zmq::context_t context_;
    zmq::socket_t socket_;
    std::string peer_address_;
};

}  // namespace vantage
