#pragma once

#include <optional>
#include <string>

#include "common/pairing/pair_code.h"
#include "common/pairing/pair_message.h"
#include "common/wire/curve_keys.h"

namespace vantage {

/// One attempt to pair a host and a rig. The host commits, the rig offers, the host reveals; then
/// both show the code. Each end proves that its person confirmed the code. An end that has
/// confirmed and has the other's proof trusts the other's key. A message out of turn throws Error
/// and ends the attempt.
class Pairing {
  public:
    /// The code that both persons compare; empty until it is known.
    const std::optional<std::string>& code() const { return code_; }

    /// Records that the person at this end confirmed the code. Call it once. Precondition: there
    /// is a code.
    PairConfirm confirm();
    bool is_confirmed() const { return is_confirmed_; }
    /// Whether both ends have confirmed.
    bool is_agreed() const { return is_confirmed_ && is_proven_; }

  protected:
    Pairing(PairEnd own_end, std::string own_secret_key);
    ~Pairing() = default;

    PairTranscript said;
    void show_code(const std::string& other_public_key);
    void take_proof(const PairConfirm& confirm);

  private:
    PairEnd own_end_;
    std::string own_secret_key_, other_public_key_;
    PairBytes digest_{};
    std::optional<std::string> code_;
    bool is_confirmed_ = false, is_proven_ = false;
};

class HostPairing : public Pairing {
  public:
    /// `name`: the name of this host, as check_name() requires.
    HostPairing(const CurveKeys& keys, std::string name);

    PairCommit commit() const { return said.commit; }
    /// Takes a message in. Returns the answer to an offer.
    std::optional<PairMessage> hear(const PairMessage& message);

    /// The rig's identity by its own account; trustworthy once is_agreed().
    const PairOffer& rig() const { return said.offer; }
};

class RigPairing : public Pairing {
  public:
    /// `offer`: without nonce and key, which are filled in.
    RigPairing(const CurveKeys& keys, PairOffer offer, const PairCommit& commit);

    const PairOffer& offer() const { return said.offer; }
    void hear(const PairMessage& message);

    /// The host's identity by its own account; trustworthy once is_agreed().
    const PairReveal& host() const { return said.reveal; }
};

}  // namespace vantage
