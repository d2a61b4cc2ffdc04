#include <map>

#include <gtest/gtest.h>

#include "host_app/desk/windows/gl_window.h"

namespace vantage {
namespace {

/// A US keyboard, but for these keys.
KeyCaps keyboard(std::map<char, std::string> others) {
    return KeyCaps(
        [others = std::move(others)](int key) {
            const auto found = others.find(static_cast<char>(key));
            return found == others.end() ? std::string(1, static_cast<char>(key)) : found->second;
        },
        ",.;'/[]\\-=");
}

TEST(KeyCaps, OfAUsKeyboardAreTheirPlaces) {
    const KeyCaps caps = keyboard({});
    for (const char key : std::string_view("AMZ19;'/\\")) EXPECT_EQ(caps.meant_by(key), key) << key;
    EXPECT_EQ(caps.meant_by(290), 290) << "F1";
    EXPECT_EQ(caps.words(), "");
}

TEST(KeyCaps, OfAFrenchKeyboardAreItsLabels) {
    const KeyCaps caps = keyboard({{'A', "q"},
                                   {'Q', "a"},
                                   {'Z', "w"},
                                   {'W', "z"},
                                   {';', "m"},
                                   {'M', ","},
                                   {',', ";"},
                                   {'.', ":"},
                                   {'/', "!"},
                                   {'\'', "ù"},
                                   {'[', "^"},
                                   {']', "$"},
                                   {'\\', "*"},
                                   {'-', ")"},
                                   {'4', "'"}});
    EXPECT_EQ(caps.meant_by(';'), 'M') << "the key labelled M must not cut";
    EXPECT_EQ(caps.meant_by(','), ';');
    EXPECT_EQ(caps.meant_by('M'), ',');
    EXPECT_EQ(caps.meant_by('W'), 'Z');
    EXPECT_EQ(caps.place_of('W'), 'Z');
    EXPECT_EQ(caps.meant_by('4'), '4') << "digits go by their place";
    EXPECT_EQ(caps.meant_by('.'), '.') << "no cap has it";
    EXPECT_EQ(caps.meant_by('/'), '/');
    EXPECT_NE(caps.words().find("M is where a US keyboard has ;"), std::string::npos)
        << caps.words();
}

TEST(KeyCaps, OfAGermanKeyboardHaveYAndZExchanged) {
    const KeyCaps caps = keyboard({{'Y', "z"}, {'Z', "y"}, {';', "ö"}, {'-', "ß"}, {'/', "-"}});
    EXPECT_EQ(caps.meant_by('Y'), 'Z');
    EXPECT_EQ(caps.meant_by('Z'), 'Y');
    EXPECT_EQ(caps.meant_by('/'), '-');
    EXPECT_EQ(caps.meant_by('-'), -1) << "another cap has it";
    EXPECT_EQ(caps.place_of('-'), '/');
    EXPECT_EQ(caps.place_of('/'), -1);
}

TEST(KeyCaps, WithoutLatinLettersAreTheirPlaces) {
    const KeyCaps caps = keyboard({{'M', "ь"}, {'A', "ф"}});
    EXPECT_EQ(caps.meant_by('M'), 'M');
    EXPECT_EQ(caps.meant_by('A'), 'A');
}

TEST(KeyGuardTest, ConfirmsTheSecondPressInTime) {
    KeyGuard guard;
    EXPECT_FALSE(guard.confirms("end?", 10));
    EXPECT_EQ(guard.question(11), "end?");
    EXPECT_TRUE(guard.confirms("end?", 12));
    EXPECT_EQ(guard.question(12), "") << "it is answered";
    EXPECT_FALSE(guard.confirms("end?", 12.1)) << "and asked again the next time";
}

TEST(KeyGuardTest, ForgetsAQuestionAfterItsTime) {
    KeyGuard guard;
    EXPECT_FALSE(guard.confirms("end?", 10));
    EXPECT_EQ(guard.question(10 + KeyGuard::asks_for_s), "");
    EXPECT_FALSE(guard.confirms("end?", 10 + KeyGuard::asks_for_s));
}

TEST(KeyGuardTest, ANewQuestionReplacesTheFirst) {
    KeyGuard guard;
    EXPECT_FALSE(guard.confirms("end?", 10));
    EXPECT_FALSE(guard.confirms("replace?", 11));
    EXPECT_FALSE(guard.confirms("end?", 12));
    EXPECT_TRUE(guard.confirms("end?", 13));
}

}  // namespace

}  // namespace vantage
