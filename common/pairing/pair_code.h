#pragma once

#include <string>

#include "common/pairing/pair_message.h"

namespace vantage {

// How a person's comparing of a short code proves that nobody stands between two ends: the
// commitment and short authentication string of Vaudenay, "Secure Communications over Insecure
// Channels Based on Short Authenticated Strings", CRYPTO 2005, with each end's nonce and identity
// hashed (BLAKE2b, libsodium). Who stands between has to choose what it says to either end before
// it knows what the codes will be: one guess in a million an attempt, and attempts are few.

/// 32 bytes of the system's entropy.
PairBytes random_pair_bytes();

/// What a host says first of the reveal that it keeps to itself till the rig has offered.
PairBytes pair_commitment(const PairReveal& reveal);

/// All that both ends have said until they show the code.
struct PairTranscript {
    PairCommit commit;
    PairOffer offer;
    PairReveal reveal;
};
PairBytes digest_of(const PairTranscript& transcript);

/// Six digits in two groups: "483 920".
std::string pair_code(const PairBytes& digest);

/// A person has typed this very code, with or without its blank.
bool is_same_code(const std::string& typed, const std::string& code);

enum class PairEnd { host, rig };
/// That this end's person has confirmed the transcript with this digest, and that this end holds
/// the secret key to the public one it named: a keyed hash under the secret that both key pairs
/// share (X25519). Both keys Z85. Throws Error for a public key that shares no secret.
PairBytes pair_proof(PairEnd end, const PairBytes& digest, const std::string& own_secret_key,
                     const std::string& other_public_key);

/// In a time that says nothing about where they differ.
bool same_bytes(const PairBytes& a, const PairBytes& b);

}  // namespace vantage
