#pragma once

#include <string>

#include "common/pairing/pair_message.h"

namespace vantage {

// Authenticates two ends by a short code that people compare: commitment and short authentication
// string of Vaudenay, "Secure Communications over Insecure Channels Based on Short Authenticated
// Strings", CRYPTO 2005. Each end's nonce and identity are hashed (BLAKE2b, libsodium). A
// man in the middle has to commit before it knows the codes: its chance is one in a million per
// attempt, and attempts are limited.

/// 32 random bytes from the system.
PairBytes random_pair_bytes();

/// The host's commitment to the reveal that it sends after the rig's offer.
PairBytes pair_commitment(const PairReveal& reveal);

/// All messages that both ends exchanged before they show the code.
struct PairTranscript {
    PairCommit commit;
    PairOffer offer;
    PairReveal reveal;
};
PairBytes digest_of(const PairTranscript& transcript);

/// The code: six digits in two groups, "483 920".
std::string pair_code(const PairBytes& digest);

/// Whether a person typed this code, with or without the space.
bool is_same_code(const std::string& typed, const std::string& code);

enum class PairEnd { host, rig };
/// Proves that the person at this end confirmed the transcript with this digest, and that this end
/// holds the secret key of its public one: a keyed hash under the secret that both key pairs share
/// (X25519). Keys are in Z85. Throws Error for a public key that yields no shared secret.
PairBytes pair_proof(PairEnd end, const PairBytes& digest, const std::string& own_secret_key,
                     const std::string& other_public_key);

/// Compares in constant time.
bool same_bytes(const PairBytes& a, const PairBytes& b);

}  // namespace vantage
