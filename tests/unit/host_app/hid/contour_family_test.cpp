#include <gtest/gtest.h>

#include "tests/unit/host_app/hid/decoded.h"

namespace vantage {
namespace {

using Events = std::vector<JogEvent>;

TEST(ContourDecoder, TakesTheFirstReportOnlyAsTheCountersStart) {
    const auto decoder = decoder_of("0b33:0020");
    EXPECT_EQ(decoded(*decoder, {0, 0x83, 0, 0, 0}), Events{});
    EXPECT_EQ(decoded(*decoder, {0, 0x85, 0, 0, 0}), Events{step("jog", 2)});
}

TEST(ContourDecoder, CountsTheJogOverItsWrapEitherWay) {
    const auto decoder = decoder_of("0b33:0020");
    decoded(*decoder, {0, 0xff, 0, 0, 0});
    EXPECT_EQ(decoded(*decoder, {0, 0x01, 0, 0, 0}), Events{step("jog", 2)});
    EXPECT_EQ(decoded(*decoder, {0, 0xfe, 0, 0, 0}), Events{step("jog", -3)});
}

TEST(ContourDecoder, ReadsTheRingFromEndToEnd) {
    const auto decoder = decoder_of("0b33:0020");
    EXPECT_EQ(decoded(*decoder, {0x07, 0, 0, 0, 0}), Events{axis("shuttle", 1)});
    EXPECT_EQ(decoded(*decoder, {0xf9, 0, 0, 0, 0}), Events{axis("shuttle", -1)});
    EXPECT_EQ(decoded(*decoder, {0x03, 0, 0, 0, 0}), Events{axis("shuttle", 3.0 / 7)});
    EXPECT_EQ(decoded(*decoder, {0x03, 0, 0, 0, 0}), Events{}) << "it did not move";
    EXPECT_EQ(decoded(*decoder, {0x00, 0, 0, 0, 0}), Events{axis("shuttle", 0)});
}

TEST(ContourDecoder, NumbersTheFiveButtonsOfTheXpressFromItsFourthBit) {
    const auto decoder = decoder_of("0b33:0020");
    EXPECT_EQ(decoded(*decoder, {0, 0, 0, 0x10, 0x01}), (Events{press("b1"), press("b5")}));
    EXPECT_EQ(decoded(*decoder, {0, 0, 0, 0x00, 0x01}), Events{let_go("b1")});
    EXPECT_EQ(decoded(*decoder, {0, 0, 0, 0x0f, 0xff}), Events{}) << "bits that are no button";
}

TEST(ContourDecoder, NumbersTheFifteenButtonsOfTheProV2) {
    const auto decoder = decoder_of("0b33:0030");
    EXPECT_EQ(decoded(*decoder, {0, 0, 0, 0x01, 0x40}), (Events{press("b1"), press("b15")}));
    EXPECT_EQ(decoder->controls().size(), 17u);
    EXPECT_EQ(decoder_of("0b33:0010")->controls().size(), 15u);
}

TEST(ContourDecoder, RefusesWhatIsNoReportOfIt) {
    const auto decoder = decoder_of("0b33:0020");
    EXPECT_FALSE(takes(*decoder, {}));
    EXPECT_FALSE(takes(*decoder, {0, 1, 0, 0}));
    EXPECT_FALSE(takes(*decoder, {0, 1, 0, 0, 0, 0}));
    EXPECT_FALSE(takes(*decoder, {8, 1, 0, 0, 0})) << "the ring ends at 7";
}

}  // namespace
}  // namespace vantage
