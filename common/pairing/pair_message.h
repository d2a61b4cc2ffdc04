#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace vantage {

/// A hash, nonce or proof of the pairing protocol.
using PairBytes = std::array<std::uint8_t, 32>;

/// From host to rig, first message: the hash of the later reveal (pair_commitment()).
struct PairCommit {
    PairBytes commitment{};
    bool operator==(const PairCommit&) const = default;
};

/// From rig to host: the rig's identity.
struct PairOffer {
    std::string rig;
    std::string public_key;  ///< Z85
    PairBytes nonce{};
    int stream_port = 0;  ///< of the rig's stream; 0: a new one at every start
    double rate_hz = 30;  ///< the trigger rate in the rig's configuration
    bool operator==(const PairOffer&) const = default;
};

/// From host to rig: the content of the commitment.
struct PairReveal {
    std::string host;
    std::string public_key;  ///< Z85
    PairBytes nonce{};
    bool operator==(const PairReveal&) const = default;
};

/// From either end, after its person has confirmed the code (pair_proof()).
struct PairConfirm {
    PairBytes proof{};
    bool operator==(const PairConfirm&) const = default;
};

/// From either end: ends the pairing.
struct PairRefusal {
    std::string why;  ///< one sentence
    bool operator==(const PairRefusal&) const = default;
};

using PairMessage = std::variant<PairCommit, PairOffer, PairReveal, PairConfirm, PairRefusal>;

std::vector<std::byte> encode(const PairMessage& message);

/// Decodes an untrusted message. Throws Error with one sentence if it is truncated, oversized, of
/// another schema version, or out of range.
PairMessage decode_pair_message(std::span<const std::byte> part);

}  // namespace vantage
