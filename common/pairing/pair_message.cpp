#include "common/pairing/pair_message.h"

#include <algorithm>
#include <cmath>

#include "common/base/error.h"
#include "common/wire/curve_keys.h"
#include "common/wire/header_fields.h"
#include "common/wire/limits.h"
#include "pair.pb.h"

namespace vantage {
namespace {

constexpr std::size_t max_why_chars = 512;
constexpr int highest_port = 65535;
/// The limits of rig.toml and stage.toml.
constexpr double least_rate_hz = 0.01, most_rate_hz = 1000;

PairBytes bytes_from(const std::string& text, const char* what) {
    PairBytes bytes{};
    if (text.size() != bytes.size())
        fail("a {} of {} bytes came where {} belong", what, text.size(), bytes.size());
    std::copy(text.begin(), text.end(), bytes.begin());
    return bytes;
}

std::string text_of(const PairBytes& bytes) { return {bytes.begin(), bytes.end()}; }

void check_key(const std::string& key) {
    if (!is_curve_key(key)) fail("a public key came that is none");
}

void to_wire(const PairCommit& commit, wire::PairMessage& out) {
    out.mutable_commit()->set_commitment(text_of(commit.commitment));
}
void to_wire(const PairOffer& offer, wire::PairMessage& out) {
    wire::PairOffer& to = *out.mutable_offer();
    to.set_rig(offer.rig);
    to.set_public_key(offer.public_key);
    to.set_nonce(text_of(offer.nonce));
    to.set_stream_port(static_cast<std::uint32_t>(offer.stream_port));
    to.set_rate_hz(offer.rate_hz);
}
void to_wire(const PairReveal& reveal, wire::PairMessage& out) {
    wire::PairReveal& to = *out.mutable_reveal();
    to.set_host(reveal.host);
    to.set_public_key(reveal.public_key);
    to.set_nonce(text_of(reveal.nonce));
}
void to_wire(const PairConfirm& confirm, wire::PairMessage& out) {
    out.mutable_confirm()->set_proof(text_of(confirm.proof));
}
void to_wire(const PairRefusal& refusal, wire::PairMessage& out) {
    out.mutable_refusal()->set_why(refusal.why.substr(0, max_why_chars));
}

PairOffer from_wire(const wire::PairOffer& in) {
    check_name("rig", in.rig());
    check_key(in.public_key());
    if (in.stream_port() > highest_port) fail("port {} came, which is none", in.stream_port());
    if (!(in.rate_hz() >= least_rate_hz && in.rate_hz() <= most_rate_hz))
        fail("a rate of {} Hz came, outside {}..{}", in.rate_hz(), least_rate_hz, most_rate_hz);
    return {in.rig(), in.public_key(), bytes_from(in.nonce(), "nonce"),
            static_cast<int>(in.stream_port()), in.rate_hz()};
}

PairReveal from_wire(const wire::PairReveal& in) {
    check_name("host", in.host());
    check_key(in.public_key());
    return {in.host(), in.public_key(), bytes_from(in.nonce(), "nonce")};
}

PairRefusal from_wire(const wire::PairRefusal& in) {
    const std::string& why = in.why();
    if (why.size() > max_why_chars)
        fail("a refusal of {} characters is beyond the limit of {}", why.size(), max_why_chars);
    // The text is shown at a terminal, so it must not contain control characters.
    constexpr unsigned char first_printable = ' ', del = 127;
    if (std::any_of(why.begin(), why.end(), [](char c) {
            const auto byte = static_cast<unsigned char>(c);
            return byte < first_printable || byte >= del;
        }))
        fail("a refusal came with characters that cannot be shown");
    return {why};
}

}  // namespace

std::vector<std::byte> encode(const PairMessage& message) {
    wire::PairMessage out;
    out.set_schema_version(wire_schema_version);
    std::visit([&](const auto& content) { to_wire(content, out); }, message);
    return serialise(out);
}

PairMessage decode_pair_message(std::span<const std::byte> part) {
    wire::PairMessage in;
    parse(part, "pairing message", in);
    check_schema_version("pairing message", in.schema_version());
    switch (in.content_case()) {
        case wire::PairMessage::kCommit:
            return PairCommit{bytes_from(in.commit().commitment(), "commitment")};
        case wire::PairMessage::kOffer:
            return from_wire(in.offer());
        case wire::PairMessage::kReveal:
            return from_wire(in.reveal());
        case wire::PairMessage::kConfirm:
            return PairConfirm{bytes_from(in.confirm().proof(), "proof")};
        case wire::PairMessage::kRefusal:
            return from_wire(in.refusal());
        case wire::PairMessage::CONTENT_NOT_SET:
            break;
    }
    fail("a pairing message without content came");
}

}  // namespace vantage
