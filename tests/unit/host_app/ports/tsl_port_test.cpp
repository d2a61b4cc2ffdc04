#include "host_app/control/ports/messages/tsl_message.h"
#include "tests/support/thrown_sentence.h"
#include "tests/unit/host_app/ports/bench_test.h"
#include "tests/unit/host_app/ports/local_caller.h"

namespace vantage {
namespace {

std::string v3(int address, int control) {
    std::string message(18, ' ');
    message[0] = static_cast<char>(0x80 + address);
    message[1] = static_cast<char>(control);
    return message;
}

std::string word(unsigned value) {
    return {static_cast<char>(value & 0xff), static_cast<char>(value >> 8)};
}
std::string display(unsigned index, unsigned control) {
    return word(index) + word(control) + word(5) + "VIRT1";
}
std::string v5(const std::string& displays) {
    return word(static_cast<unsigned>(displays.size() + 4)) + std::string(4, '\0') + displays;
}

/// As TCP carries it.
std::string wrapped(const std::string& message) {
    std::string bytes = "\xfe\x02";
    for (const char byte : message) bytes += byte == '\xfe' ? "\xfe\xfe" : std::string(1, byte);
    return bytes;
}

std::optional<std::vector<TslDisplay>> decoded(const std::string& bytes) {
    return decode_tsl(std::as_bytes(std::span(bytes)));
}

TEST(TslMessage, OfVersionThreeHasAnAddressAndFourTallies) {
    const auto displays = decoded(v3(5, 0x31));
    ASSERT_TRUE(displays);
    EXPECT_EQ(displays->at(0).address, 5);
    EXPECT_EQ(displays->at(0).tallies, 1u) << "brightness is no tally";
    EXPECT_FALSE(decoded(v3(5, 0x41)));
    EXPECT_FALSE(decoded(v3(127, 1)));
    EXPECT_FALSE(decoded(v3(5, 1).substr(1)));
    std::string padded = v3(5, 1);
    padded[17] = '\0';
    EXPECT_TRUE(decoded(padded)) << "the text is shown nowhere";
    const auto two = decoded(v3(5, 1) + v3(6, 2));
    ASSERT_TRUE(two);
    EXPECT_EQ(two->size(), 2u);
    for (const std::string& padding : {std::string(4, '\0'), std::string("\r\n")}) {
        EXPECT_TRUE(decoded(v3(5, 1) + padding)) << "a datagram may be padded";
        EXPECT_TRUE(decoded(v5(display(1, 1)) + padding));
        EXPECT_FALSE(decoded(padding)) << "but has a message";
    }
    EXPECT_FALSE(decoded(v3(5, 1) + "\r\n\1"));
    std::string v4 = v3(5, 1);
    unsigned sum = 0;
    for (const char byte : v4) sum += static_cast<unsigned char>(byte);
    v4 += {static_cast<char>((0x80 - sum % 0x80) % 0x80), '\2', '\1', '\1'};
    const auto of_v4 = decoded(v4 + v3(6, 2));
    ASSERT_TRUE(of_v4);
    EXPECT_EQ(of_v4->size(), 2u);
}

TEST(TslMessage, OfVersionFiveHasAnyNumberOfDisplays) {
    const auto displays = decoded(v5(display(1, 0x00c1) + display(300, 0x0020) + display(2, 0)));
    ASSERT_TRUE(displays);
    ASSERT_EQ(displays->size(), 3u);
    EXPECT_EQ(displays->at(0).tallies, 1u) << "its right lamp is red";
    EXPECT_EQ(displays->at(1).address, 300);
    EXPECT_EQ(displays->at(1).tallies, 2u) << "its left lamp is green";
    EXPECT_EQ(displays->at(2).tallies, 0u);
    const std::string whole = v5(display(1, 1));
    for (std::size_t bytes = 0; bytes < whole.size(); ++bytes)
        EXPECT_FALSE(decoded(whole.substr(0, bytes))) << bytes;
    EXPECT_FALSE(decoded(v5(word(1) + word(1) + word(6) + "VIRT1"))) << "the text is cut off";
}

TEST(TslMessage, OfVersionFiveMayBeWrappedOrSeveralInADatagram) {
    for (const std::string& bytes : {wrapped(v5(display(7, 1))) + wrapped(v5(display(0x02fe, 2))),
                                     v5(display(7, 1)) + v5(display(0x02fe, 2))}) {
        const auto displays = decoded(bytes);
        ASSERT_TRUE(displays);
        ASSERT_EQ(displays->size(), 2u);
        EXPECT_EQ(displays->at(1).address, 0x02fe);
    }
    EXPECT_FALSE(decoded(wrapped(v5(display(7, 1))).substr(0, 9)));
}

TEST(TslStream, TakesMessagesWithoutTheirWrapping) {
    const std::string first = v5(display(0x02fe, 1)), second = v3(5, 2);
    const std::string bytes = first + wrapped(first) + second + second;
    for (std::size_t cut = 0; cut <= bytes.size(); ++cut) {
        TslStream stream;
        std::vector<std::string> messages = stream.take(bytes.substr(0, cut));
        for (std::string& message : stream.take(bytes.substr(cut)))
            messages.push_back(std::move(message));
        EXPECT_EQ(messages, (std::vector{first, first, second, second})) << cut;
        EXPECT_EQ(stream.strays(), 0u) << cut;
        EXPECT_FALSE(stream.has_rest());
    }
    TslStream stream;
    (void)stream.take(first.substr(0, 9));
    EXPECT_TRUE(stream.has_rest());
}

TEST(TslStream, TakesMessagesApartWhereverTheirBytesAreCut) {
    // An index that has a DLE in it.
    const std::string first = v5(display(0x02fe, 1)), second = v5(display(7, 2));
    const std::string bytes = wrapped(first) + wrapped(second);
    for (std::size_t cut = 0; cut <= bytes.size(); ++cut) {
        TslStream stream;
        std::vector<std::string> messages = stream.take(bytes.substr(0, cut));
        for (std::string& message : stream.take(bytes.substr(cut)))
            messages.push_back(std::move(message));
        EXPECT_EQ(messages, (std::vector{first, second})) << cut;
        EXPECT_EQ(stream.strays(), 0u) << cut;
    }
}

TEST(TslStream, GoesOnAfterWhatIsNoMessage) {
    const std::string message = v5(display(7, 2)), framed = wrapped(message);
    const std::string too_long = std::string("\xfe\x02") + word(0x7001) + std::string(3000, 'x');
    for (const std::string& rubbish :
         {std::string("no tally"), std::string("\xfe\x05"), framed.substr(0, framed.size() - 1),
          too_long, std::string("\xfe\xfe")}) {
        TslStream stream;
        EXPECT_EQ(stream.take(rubbish + framed), std::vector{message}) << rubbish;
        EXPECT_EQ(stream.strays(), 1u) << rubbish;
    }
}

TEST_F(BenchTest, TheMixerLightsTheTallyOfItsDisplayOnly) {
    const auto port = open("tsl", "?address=5");
    peer_.send(v3(4, 1), number_);
    peer_.send(v3(5, 2), number_);
    serve(*port, 2);
    EXPECT_EQ(tally_.state(), (Tally::State{.programme = false, .preview = true}));
    peer_.send(v5(display(4, 2) + display(5, 1)), number_);
    peer_.send("no tally", number_);
    serve(*port, 4);
    EXPECT_EQ(tally_.state(), (Tally::State{.programme = true, .preview = false}));
    EXPECT_EQ(port->stats().obeyed, 3u);
    EXPECT_EQ(port->stats().malformed, 1u);
}

TEST_F(BenchTest, AMixerMayTellItOverTcp) {
    const auto port = open("tsl", "?over=tcp&address=5");
    const LocalCaller mixer(number_), other(number_);
    mixer.say(wrapped(v5(display(4, 2) + display(5, 1))).substr(0, 9));
    other.say("no tally");
    serve(*port, 1);
    EXPECT_EQ(port->stats().malformed, 1u);
    EXPECT_EQ(tally_.state(), Tally::State{});
    mixer.say(wrapped(v5(display(4, 2) + display(5, 1))).substr(9));
    serve(*port, 2);
    EXPECT_EQ(port->stats().obeyed, 1u) << port->stats().last_refusal;
    EXPECT_EQ(tally_.state(), (Tally::State{.programme = true, .preview = false}));
    mixer.say(wrapped(v5(word(1) + word(1) + word(6) + "VIRT1")));
    serve(*port, 3);
    EXPECT_EQ(port->stats().malformed, 2u) << "the text is cut off";
    EXPECT_NE(thrown_sentence([&] { (void)open("tsl", "?over=pigeon"); }).find("tcp"),
              std::string::npos);
}

TEST_F(BenchTest, AMessageToEveryDisplayLightsThisOne) {
    const auto port = open("tsl", "?address=5");
    peer_.send(v5(display(0xffff, 1)), number_);
    serve(*port, 1);
    EXPECT_EQ(tally_.state(), (Tally::State{.programme = true, .preview = false}));
}

TEST_F(BenchTest, WhatAMixerLeavesUnfinishedIsCounted) {
    const auto port = open("tsl", "?over=tcp&address=5");
    {
        const LocalCaller mixer(number_);
        mixer.say(wrapped(v5(display(5, 1))).substr(0, 9));
    }
    serve(*port, 1);
    EXPECT_EQ(port->stats().malformed, 1u);
}

TEST_F(BenchTest, ThePlaceOfTheTalliesCanBeSaid) {
    const auto port = open("tsl", "?programme=2&preview=1");
    peer_.send(v3(0, 2), number_);
    serve(*port, 1);
    EXPECT_EQ(tally_.state(), (Tally::State{.programme = true, .preview = false}));
}

}  // namespace
}  // namespace vantage
