#include "common/pairing/pairing.h"

#include <gtest/gtest.h>

#include "tests/support/thrown_sentence.h"

namespace vantage {
namespace {

PairOffer north() {
    PairOffer offer;
    offer.rig = "north";
    offer.stream_port = 5600;
    return offer;
}

/// What the two ends send each other, each through its encoding.
PairMessage sent(const PairMessage& message) { return decode_pair_message(encode(message)); }

struct Ends {
    CurveKeys host_keys = generate_curve_keys(), rig_keys = generate_curve_keys();
    HostPairing host{host_keys, "gallery"};
    RigPairing rig{rig_keys, north(), std::get<PairCommit>(sent(host.commit()))};

    void show_codes() { rig.hear(sent(*host.hear(sent(rig.offer())))); }
};

TEST(Pairing, ShowsTheSameCodeAtBothEndsAndExchangesKeys) {
    Ends ends;
    EXPECT_FALSE(ends.host.code());
    ends.show_codes();
    ASSERT_TRUE(ends.host.code() && ends.rig.code());
    EXPECT_EQ(*ends.host.code(), *ends.rig.code());
    EXPECT_EQ(ends.host.code()->size(), 7u) << "two groups of three digits";
    const PairMessage of_host = sent(ends.host.confirm());
    ends.rig.hear(of_host);
    EXPECT_FALSE(ends.rig.is_agreed()) << "its own person has not confirmed";
    ends.host.hear(sent(ends.rig.confirm()));
    EXPECT_TRUE(ends.host.is_agreed());
    EXPECT_TRUE(ends.rig.is_agreed());
    EXPECT_EQ(ends.host.rig().public_key, ends.rig_keys.public_key);
    EXPECT_EQ(ends.rig.host().public_key, ends.host_keys.public_key);
    EXPECT_EQ(ends.rig.host().host, "gallery");
}

TEST(Pairing, ShowsAnotherCodeEveryTime) {
    const CurveKeys host_keys = generate_curve_keys(), rig_keys = generate_curve_keys();
    std::set<std::string> codes;
    for (int i = 0; i < 20; ++i) {
        HostPairing host(host_keys, "gallery");
        RigPairing rig(rig_keys, north(), host.commit());
        rig.hear(*host.hear(rig.offer()));
        codes.insert(*rig.code());
    }
    EXPECT_GT(codes.size(), 15u);
}

/// Who stands between plays the rig to the host and a host to the rig, with keys of its own.
TEST(Pairing, ShowsDifferentCodesWithAManInTheMiddle) {
    const CurveKeys between = generate_curve_keys();
    int same = 0;
    for (int i = 0; i < 20; ++i) {
        HostPairing host(generate_curve_keys(), "gallery");
        HostPairing false_host(between, "gallery");
        RigPairing rig(generate_curve_keys(), north(), false_host.commit());
        RigPairing false_rig(between, north(), host.commit());
        rig.hear(*false_host.hear(rig.offer()));
        false_rig.hear(*host.hear(false_rig.offer()));
        same += *host.code() == *rig.code() ? 1 : 0;
        // The person at the host errs, and what the rig then gets is no proof to it.
        EXPECT_NE(thrown_sentence([&] { rig.hear(host.confirm()); }).find("stand between"),
                  std::string::npos);
        EXPECT_FALSE(rig.is_agreed());
    }
    EXPECT_LE(same, 1) << "two are the same by chance once in five billion runs of this test";
}

/// Without the commitment it could try nonces until the codes meet.
TEST(Pairing, RefusesARevealWithoutItsCommitment) {
    Ends ends;
    PairReveal other = std::get<PairReveal>(*ends.host.hear(ends.rig.offer()));
    other.nonce[0] ^= 1;
    EXPECT_NE(thrown_sentence([&] { ends.rig.hear(other); }).find("committed"), std::string::npos);
    EXPECT_FALSE(ends.rig.code());
}

TEST(Pairing, RefusesASecondOfferOnceTheHostHasRevealed) {
    Ends ends;
    ends.show_codes();
    PairOffer other = ends.rig.offer();
    other.nonce[0] ^= 1;
    EXPECT_NE(thrown_sentence([&] { ends.host.hear(other); }).find("out of turn"),
              std::string::npos);
}

TEST(Pairing, RefusesMessagesOfAnotherPairing) {
    Ends before;
    before.show_codes();
    const PairConfirm old = before.host.confirm();
    const PairMessage old_reveal = *Ends().host.hear(before.rig.offer());
    // The same two ends with the same keys, anew.
    HostPairing host(before.host_keys, "gallery");
    RigPairing rig(before.rig_keys, north(), host.commit());
    EXPECT_FALSE(thrown_sentence([&] { rig.hear(old_reveal); }).empty());
    rig.hear(*host.hear(rig.offer()));
    EXPECT_FALSE(thrown_sentence([&] { rig.hear(old); }).empty());
    EXPECT_FALSE(rig.is_agreed());
}

TEST(Pairing, RefusesItsOwnProof) {
    Ends ends;
    ends.show_codes();
    const PairConfirm of_host = ends.host.confirm();
    EXPECT_FALSE(thrown_sentence([&] { ends.host.hear(of_host); }).empty());
    EXPECT_FALSE(ends.host.is_agreed());
}

TEST(Pairing, ProvesThatAnEndHoldsItsSecretKey) {
    const CurveKeys true_keys = generate_curve_keys();
    CurveKeys stolen = true_keys;
    stolen.secret_key = generate_curve_keys().secret_key;
    HostPairing host(stolen, "gallery");
    RigPairing rig(generate_curve_keys(), north(), host.commit());
    rig.hear(*host.hear(rig.offer()));
    EXPECT_EQ(*rig.code(), *host.code());
    EXPECT_FALSE(thrown_sentence([&] { rig.hear(host.confirm()); }).empty());
}

TEST(PairCode, MatchesWithOrWithoutTheSpace) {
    EXPECT_TRUE(is_same_code("483920", "483 920"));
    EXPECT_TRUE(is_same_code(" 483 920 \r", "483 920"));
    EXPECT_FALSE(is_same_code("483921", "483 920"));
    EXPECT_FALSE(is_same_code("", "483 920"));
    EXPECT_FALSE(is_same_code("yes", "483 920"));
}

TEST(PairMessage, RoundTripsAndRefusesInvalidMessages) {
    PairOffer offer = north();
    offer.public_key = generate_curve_keys().public_key;
    offer.nonce = random_pair_bytes();
    EXPECT_EQ(std::get<PairOffer>(sent(offer)), offer);
    const PairRefusal refusal{"a sentence"};
    EXPECT_EQ(std::get<PairRefusal>(sent(refusal)), refusal);
    PairOffer bad = offer;
    bad.rig = "a b";
    EXPECT_FALSE(thrown_sentence([&] { sent(bad); }).empty());
    bad = offer;
    bad.public_key = "short";
    EXPECT_FALSE(thrown_sentence([&] { sent(bad); }).empty());
    bad = offer;
    bad.stream_port = 70000;
    EXPECT_FALSE(thrown_sentence([&] { sent(bad); }).empty());
    bad = offer;
    bad.rate_hz = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(thrown_sentence([&] { sent(bad); }).empty());
    EXPECT_FALSE(thrown_sentence([] { sent(PairRefusal{"\x1b[2J"}); }).empty());
    const std::vector<std::byte> whole = encode(offer);
    EXPECT_FALSE(thrown_sentence([&] {
                     decode_pair_message(std::span(whole).first(whole.size() - 3));
                 }).empty());
    EXPECT_FALSE(thrown_sentence([] { decode_pair_message({}); }).empty());
}

}  // namespace
}  // namespace vantage
