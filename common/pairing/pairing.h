#pragma once

#include <optional>
#include <string>

#include "common/pairing/pair_code.h"
#include "common/pairing/pair_message.h"
#include "common/wire/curve_keys.h"

namespace vantage {

/// One attempt to pair, as both ends see it. The host commits, the rig offers, the host reveals;
/// then both show the code. Either end proves that its person has confirmed; who has confirmed and
/// has the other's proof trusts the other's key. Messages that do not fit throw Error, and the
/// attempt is over.
class Pairing {
  public:
    /// What both persons compare; nothing as long as it is not known.
    const std::optional<std::string>& code() const { return code_; }

    /// The person here has compared the codes. Precondition: there is a code. Once.
    PairConfirm confirm();
    bool is_confirmed() const { return is_confirmed_; }
    /// Both have confirmed.
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
    /// `name`: of this host, as check_name() has it.
    HostPairing(const CurveKeys& keys, std::string name);

    PairCommit commit() const { return said.commit; }
    /// The answer to an offer, if this is one.
    std::optional<PairMessage> hear(const PairMessage& message);

    /// Who the rig says it is. To be trusted once this is_agreed().
    const PairOffer& rig() const { return said.offer; }
};

class RigPairing : public Pairing {
  public:
    /// `offer`: without nonce and key.
    RigPairing(const CurveKeys& keys, PairOffer offer, const PairCommit& commit);

    const PairOffer& offer() const { return said.offer; }
    void hear(const PairMessage& message);

    /// Who the host says it is. To be trusted once this is_agreed().
    const PairReveal& host() const { return said.reveal; }
};

}  // namespace vantage
