#include "common/pairing/pair_code.h"

#include <algorithm>
#include <bit>
#include <cctype>
#include <string_view>

#include <fmt/format.h>
#include <sodium.h>
#include <zmq.h>

#include "common/base/error.h"

namespace vantage {
namespace {

/// A hash of fields, each preceded by its length, so that fields cannot be confused.
class FieldHash {
  public:
    /// `purpose` separates the hashes of different uses.
    explicit FieldHash(std::string_view purpose, const PairBytes* key = nullptr) {
        crypto_generichash_init(&state_, key ? key->data() : nullptr, key ? key->size() : 0,
                                PairBytes().size());
        add(purpose);
    }
    void add(std::string_view field) {
        add_number(field.size());
        crypto_generichash_update(&state_, reinterpret_cast<const unsigned char*>(field.data()),
                                  field.size());
    }
    void add(const PairBytes& field) {
        add(std::string_view(reinterpret_cast<const char*>(field.data()), field.size()));
    }
    void add_number(std::uint64_t number) {
        std::array<unsigned char, sizeof(number)> bytes{};
        for (std::size_t i = 0; i < bytes.size(); ++i)
            bytes[i] = static_cast<unsigned char>(number >> (8 * i));
        crypto_generichash_update(&state_, bytes.data(), bytes.size());
    }
    PairBytes end() {
        PairBytes hash{};
        crypto_generichash_final(&state_, hash.data(), hash.size());
        return hash;
    }

  private:
    crypto_generichash_state state_{};
};

void start_sodium() {
    if (sodium_init() < 0) fail("this computer's libsodium finds no source of entropy");
}

PairBytes key_bytes(const std::string& z85) {
    PairBytes bytes{};
    if (!zmq_z85_decode(bytes.data(), z85.c_str())) fail("a key is not of 40 characters of Z85");
    return bytes;
}

}  // namespace

PairBytes random_pair_bytes() {
    start_sodium();
    PairBytes bytes{};
    randombytes_buf(bytes.data(), bytes.size());
    return bytes;
}

PairBytes pair_commitment(const PairReveal& reveal) {
    FieldHash hash("vantage pairing 1: commitment");
    hash.add(reveal.host);
    hash.add(reveal.public_key);
    hash.add(reveal.nonce);
    return hash.end();
}

PairBytes digest_of(const PairTranscript& transcript) {
    FieldHash hash("vantage pairing 1: transcript");
    hash.add(transcript.commit.commitment);
    hash.add(transcript.offer.rig);
    hash.add(transcript.offer.public_key);
    hash.add(transcript.offer.nonce);
    hash.add_number(static_cast<std::uint64_t>(transcript.offer.stream_port));
    hash.add_number(std::bit_cast<std::uint64_t>(transcript.offer.rate_hz));
    hash.add(transcript.reveal.host);
    hash.add(transcript.reveal.public_key);
    hash.add(transcript.reveal.nonce);
    return hash.end();
}

std::string pair_code(const PairBytes& digest) {
    constexpr std::uint64_t codes = 1'000'000, group = 1000;
    std::uint64_t number = 0;
    for (std::size_t i = 0; i < sizeof(number); ++i) number = number << 8 | digest[i];
    number %= codes;
    return fmt::format("{:03} {:03}", number / group, number % group);
}

bool is_same_code(const std::string& typed, const std::string& code) {
    const auto without_blanks = [](std::string text) {
        std::erase_if(text, [](unsigned char c) { return std::isspace(c) != 0; });
        return text;
    };
    return without_blanks(typed) == without_blanks(code);
}

PairBytes pair_proof(PairEnd end, const PairBytes& digest, const std::string& own_secret_key,
                     const std::string& other_public_key) {
    start_sodium();
    const PairBytes other = key_bytes(other_public_key);
    PairBytes own = key_bytes(own_secret_key), shared{};
    const bool shares = crypto_box_beforenm(shared.data(), other.data(), own.data()) == 0;
    sodium_memzero(own.data(), own.size());
    if (!shares) fail("a public key came that shares no secret with any other");
    FieldHash hash(end == PairEnd::host ? "vantage pairing 1: host" : "vantage pairing 1: rig",
                   &shared);
    sodium_memzero(shared.data(), shared.size());
    hash.add(digest);
    return hash.end();
}

bool same_bytes(const PairBytes& a, const PairBytes& b) {
    return sodium_memcmp(a.data(), b.data(), a.size()) == 0;
}

}  // namespace vantage
