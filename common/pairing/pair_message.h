#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace vantage {

/// Hashes, nonces and proofs of a pairing.
using PairBytes = std::array<std::uint8_t, 32>;

/// Host to rig, first: a hash of the reveal that follows (pair_commitment()).
struct PairCommit {
    PairBytes commitment{};
    bool operator==(const PairCommit&) const = default;
};

/// Rig to host: who it is.
struct PairOffer {
    std::string rig;
    std::string public_key;  ///< Z85
    PairBytes nonce{};
    int stream_port = 0;  ///< where it streams; 0: another one at every start
    double rate_hz = 30;  ///< of pulses, as the rig is told
    bool operator==(const PairOffer&) const = default;
};

/// Host to rig: what it had committed to.
struct PairReveal {
    std::string host;
    std::string public_key;  ///< Z85
    PairBytes nonce{};
    bool operator==(const PairReveal&) const = default;
};

/// Either way, once the person there has compared the codes (pair_proof()).
struct PairConfirm {
    PairBytes proof{};
    bool operator==(const PairConfirm&) const = default;
};

/// Either way: the end.
struct PairRefusal {
    std::string why;  ///< a sentence
    bool operator==(const PairRefusal&) const = default;
};

using PairMessage = std::variant<PairCommit, PairOffer, PairReveal, PairConfirm, PairRefusal>;

std::vector<std::byte> encode(const PairMessage& message);

/// Takes nothing on trust: throws Error with one sentence for what is truncated, oversized, of
/// another schema version, or out of range.
PairMessage decode_pair_message(std::span<const std::byte> part);

}  // namespace vantage
