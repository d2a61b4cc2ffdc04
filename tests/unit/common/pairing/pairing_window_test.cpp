#include "rig_firmware/pairing/pairing_window.h"

#include <gtest/gtest.h>

namespace vantage {
namespace {

using Limits = PairingWindow::Limits;
using Messages = std::vector<PairingWindow::Outgoing>;

/// A rig's window and a clock of its own.
struct PairingWindowTest : testing::Test {
    static PairOffer offer() {
        PairOffer north;
        north.rig = "north";
        return north;
    }
    MonotonicTime now = MonotonicClock::now();
    PairingWindow window{generate_curve_keys(), offer(), Limits(), now};
    HostPairing host{generate_curve_keys(), "gallery"};

    static bool refuses(const Messages& messages) {
        return messages.size() == 1 && std::holds_alternative<PairRefusal>(messages[0].message);
    }
    void show_codes(const std::string& route, HostPairing& of) {
        const Messages answer = window.hear(route, of.commit(), now);
        ASSERT_EQ(answer.size(), 1u);
        EXPECT_EQ(answer[0].route, route);
        window.hear(route, *of.hear(answer[0].message), now);
    }
};

TEST_F(PairingWindowTest, ClosesAfterAConfirmedPairing) {
    show_codes("a", host);
    ASSERT_TRUE(window.to_compare());
    EXPECT_EQ(window.to_compare()->code(), host.code());
    const Messages confirmed = window.confirm();
    EXPECT_FALSE(window.is_closed()) << "the host has not";
    host.hear(confirmed.at(0).message);
    window.hear("a", host.confirm(), now);
    ASSERT_TRUE(window.paired());
    EXPECT_EQ(window.paired()->host, "gallery");
    EXPECT_TRUE(window.is_closed());
    EXPECT_TRUE(refuses(window.hear("b", HostPairing(generate_curve_keys(), "x").commit(), now)));
}

TEST_F(PairingWindowTest, PairsNoHostThatThePersonAtTheRigRejects) {
    show_codes("a", host);
    window.hear("a", host.confirm(), now);
    EXPECT_TRUE(refuses(window.reject(now)));
    EXPECT_FALSE(window.paired());
    EXPECT_NE(window.take_failure().find("not the same"), std::string::npos);
    EXPECT_EQ(window.take_failure(), "");
}

TEST_F(PairingWindowTest, PairsOneHostAtATime) {
    show_codes("a", host);
    HostPairing other(generate_curve_keys(), "other");
    EXPECT_TRUE(refuses(window.hear("b", other.commit(), now)));
    EXPECT_EQ(window.to_compare()->host().host, "gallery");
}

TEST_F(PairingWindowTest, CountsAttempts) {
    for (int i = 0; i < Limits().attempts; ++i) {
        EXPECT_FALSE(window.is_closed()) << i;
        HostPairing one(generate_curve_keys(), "guesser");
        show_codes("a", one);
        window.reject(now);
    }
    EXPECT_TRUE(window.is_closed());
    EXPECT_EQ(window.attempts_made(), Limits().attempts);
    EXPECT_NE(window.why_closed().find("3 attempts"), std::string::npos);
}

TEST_F(PairingWindowTest, CountsRestartedAttempts) {
    Messages answer;
    for (int i = 0; i <= Limits().attempts; ++i)
        answer = window.hear("a", HostPairing(generate_curve_keys(), "guesser").commit(), now);
    EXPECT_TRUE(refuses(answer));
    EXPECT_TRUE(window.is_closed());
}

TEST_F(PairingWindowTest, LimitsEveryWait) {
    window.hear("a", host.commit(), now);
    EXPECT_TRUE(window.tick(now + Limits().answer_in - std::chrono::seconds(1)).empty());
    EXPECT_TRUE(refuses(window.tick(now + Limits().answer_in)));
    HostPairing second(generate_curve_keys(), "gallery");
    show_codes("a", second);
    EXPECT_TRUE(window.tick(now + Limits().answer_in).empty()) << "persons take longer";
    EXPECT_TRUE(refuses(window.tick(now + Limits().compare_in)));
    EXPECT_FALSE(window.to_compare());
    EXPECT_FALSE(window.is_closed());
    window.tick(now + Limits().open_for);
    EXPECT_TRUE(window.is_closed());
    EXPECT_FALSE(window.paired());
}

TEST_F(PairingWindowTest, EndsOnlyTheAttemptWithInvalidMessages) {
    show_codes("a", host);
    EXPECT_TRUE(refuses(window.hear_nonsense("b", "damaged", now)));
    EXPECT_TRUE(window.to_compare());
    EXPECT_TRUE(refuses(window.hear("b", host.confirm(), now)));
    EXPECT_TRUE(window.to_compare());
    EXPECT_TRUE(refuses(window.hear_nonsense("a", "damaged", now)));
    EXPECT_FALSE(window.to_compare());
}

}  // namespace
}  // namespace vantage
