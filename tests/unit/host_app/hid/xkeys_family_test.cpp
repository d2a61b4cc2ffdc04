#include <gtest/gtest.h>

#include "tests/unit/host_app/hid/decoded.h"

namespace vantage {
namespace {

using Events = std::vector<JogEvent>;

/// A report of an XK-68: everything at rest, time 0x00012345 ms.
std::vector<std::uint8_t> xk68_at_rest() {
    std::vector<std::uint8_t> report(36);
    report[0] = 1;
    report[19] = 0x01, report[20] = 0x23, report[21] = 0x45;
    return report;
}

TEST(XkeysDecoder, ReadsJogAndShuttleOfAnXk68) {
    const auto decoder = decoder_of("05f3:045a");
    auto report = xk68_at_rest();
    report[16] = 0xff;
    EXPECT_EQ(decoded(*decoder, report), Events{step("jog", -1)});
    report[16] = 0;
    report[17] = 0xfb;
    EXPECT_EQ(decoded(*decoder, report), Events{axis("shuttle", -5.0 / 7)});
}

TEST(XkeysDecoder, NamesKeysByRowAndColumn) {
    const auto decoder = decoder_of("05f3:045c");
    auto report = xk68_at_rest();
    report[2] = 0x01;
    report[11] = 0x80;
    EXPECT_EQ(decoded(*decoder, report), (Events{press("r1c1"), press("r8c10")}));
    EXPECT_EQ(decoded(*decoder, xk68_at_rest()), (Events{let_go("r1c1"), let_go("r8c10")}));
}

TEST(XkeysDecoder, ReadsAnXk12WhereItsKnobsStand) {
    const auto decoder = decoder_of("05f3:0426");
    EXPECT_EQ(decoded(*decoder, {0, 1, 0, 0x04, 0, 0, 1, 7, 0, 0, 0, 9}),
              (Events{step("jog", 1), axis("shuttle", 1), press("program_switch"), press("r3c2")}));
    EXPECT_EQ(decoded(*decoder, {0, 0, 0, 0x04, 0, 0, 0, 7, 0, 0, 0, 9}),
              Events{let_go("program_switch")});
}

TEST(XkeysDecoder, LetsTheVersionReportPassWithoutReadingKeysFromIt) {
    const auto decoder = decoder_of("05f3:0426");
    EXPECT_TRUE(takes(*decoder, {0, 214, 0xff, 0xff, 0xff, 0xff, 5, 5, 0, 0, 0, 0}));
    EXPECT_EQ(decoded(*decoder, {0, 214, 0xff, 0xff, 0xff, 0xff, 5, 5, 0, 0, 0, 0}), Events{});
}

TEST(XkeysDecoder, RefusesShortReports) {
    EXPECT_FALSE(takes(*decoder_of("05f3:045a"), std::vector<std::uint8_t>(21)));
    EXPECT_FALSE(takes(*decoder_of("05f3:0426"), std::vector<std::uint8_t>(11)));
    EXPECT_FALSE(takes(*decoder_of("05f3:0426"), {}));
}

}  // namespace
}  // namespace vantage
