#include "common/pairing/pairing.h"

#include <cassert>
#include <utility>

#include "common/base/error.h"

namespace vantage {
namespace {

[[noreturn]] void refuse_out_of_turn() { fail("a pairing message came out of turn"); }

}  // namespace

Pairing::Pairing(PairEnd own_end, std::string own_secret_key)
    : own_end_(own_end), own_secret_key_(std::move(own_secret_key)) {}

void Pairing::show_code(const std::string& other_public_key) {
    other_public_key_ = other_public_key;
    digest_ = digest_of(said);
    code_ = pair_code(digest_);
}

PairConfirm Pairing::confirm() {
    assert(code_ && !is_confirmed_);
    const PairConfirm confirm{pair_proof(own_end_, digest_, own_secret_key_, other_public_key_)};
    is_confirmed_ = true;
    return confirm;
}

void Pairing::take_proof(const PairConfirm& confirm) {
    if (!code_ || is_proven_) refuse_out_of_turn();
    const PairEnd other_end = own_end_ == PairEnd::host ? PairEnd::rig : PairEnd::host;
    if (!same_bytes(confirm.proof,
                    pair_proof(other_end, digest_, own_secret_key_, other_public_key_)))
        fail(
            "the other end confirmed something else than what this end sent: somebody may stand "
            "between the two computers; nothing is trusted");
    is_proven_ = true;
}

HostPairing::HostPairing(const CurveKeys& keys, std::string name)
    : Pairing(PairEnd::host, keys.secret_key) {
    said.reveal = {std::move(name), keys.public_key, random_pair_bytes()};
    said.commit.commitment = pair_commitment(said.reveal);
}

std::optional<PairMessage> HostPairing::hear(const PairMessage& message) {
    if (const auto* refusal = std::get_if<PairRefusal>(&message)) fail("{}", refusal->why);
    if (const auto* confirm = std::get_if<PairConfirm>(&message)) {
        take_proof(*confirm);
        return std::nullopt;
    }
    const auto* offer = std::get_if<PairOffer>(&message);
    // A second offer would let a man in the middle choose after it has seen the reveal.
    if (!offer || code()) refuse_out_of_turn();
    said.offer = *offer;
    show_code(offer->public_key);
    return said.reveal;
}

RigPairing::RigPairing(const CurveKeys& keys, PairOffer offer, const PairCommit& commit)
    : Pairing(PairEnd::rig, keys.secret_key) {
    said.commit = commit;
    said.offer = std::move(offer);
    said.offer.public_key = keys.public_key;
    said.offer.nonce = random_pair_bytes();
}

void RigPairing::hear(const PairMessage& message) {
    if (const auto* refusal = std::get_if<PairRefusal>(&message)) fail("{}", refusal->why);
    if (const auto* confirm = std::get_if<PairConfirm>(&message)) return take_proof(*confirm);
    const auto* reveal = std::get_if<PairReveal>(&message);
    if (!reveal || code()) refuse_out_of_turn();
    if (!same_bytes(pair_commitment(*reveal), said.commit.commitment))
        fail("the host revealed something else than it had committed to; nothing is trusted");
    said.reveal = *reveal;
    show_code(reveal->public_key);
}

}  // namespace vantage
