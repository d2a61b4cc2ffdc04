#include <gtest/gtest.h>

#include "tests/unit/host_app/hid/decoded.h"

namespace vantage {
namespace {

using Events = std::vector<JogEvent>;

TEST(SpaceMouseDecoder, ReadsThreeAxesAReportOfTheWiredOnes) {
    const auto decoder = decoder_of("046d:c626");
    // 175 of 350, -350, 0.
    EXPECT_EQ(decoded(*decoder, {1, 0xaf, 0x00, 0xa2, 0xfe, 0, 0}),
              (Events{axis("tx", 0.5), axis("ty", -1)}));
    EXPECT_EQ(decoded(*decoder, {2, 0, 0, 0, 0, 0x5e, 0x01}), Events{axis("rz", 1)});
    EXPECT_EQ(decoded(*decoder, {1, 0, 0, 0, 0, 0, 0}), (Events{axis("tx", 0), axis("ty", 0)}));
}

TEST(SpaceMouseDecoder, ReadsSixAxesAReportOfTheWirelessOnes) {
    const auto decoder = decoder_of("256f:c652");
    EXPECT_EQ(decoded(*decoder, {1, 0, 0, 0, 0, 0x5e, 0x01, 0, 0, 0xaf, 0, 0, 0}),
              (Events{axis("tz", 1), axis("ry", 0.5)}));
}

TEST(SpaceMouseDecoder, StaysWithinItsEndsWhenPushedBeyond) {
    EXPECT_EQ(decoded(*decoder_of("256f:c635"), {1, 0xff, 0x7f, 0x00, 0x80, 0, 0}),
              (Events{axis("tx", 1), axis("ty", -1)}));
}

TEST(SpaceMouseDecoder, ReadsButtonsFromMasksOfAnyLength) {
    const auto small = decoder_of("046d:c626");
    EXPECT_EQ(decoded(*small, {3, 0x02}), Events{press("b2")});
    EXPECT_EQ(decoded(*small, {3, 0x00}), Events{let_go("b2")});
    const auto large = decoder_of("256f:c633");
    EXPECT_EQ(decoded(*large, {3, 0, 0, 0, 0x80, 0xff, 0xff}), Events{press("b32")});
}

TEST(SpaceMouseDecoder, LetsBatteryReportsPassAndRefusesShortOnes) {
    const auto decoder = decoder_of("256f:c62e");
    EXPECT_TRUE(takes(*decoder, {0x17, 90}));
    EXPECT_FALSE(takes(*decoder, {1, 0, 0}));
    EXPECT_FALSE(takes(*decoder, {3}));
    EXPECT_FALSE(takes(*decoder, {}));
}

TEST(SpaceMouseFamily, ReadsOnlyTheMultiAxisCollectionOfAReceiver) {
    for (const JogFamily& family : jog_families()) {
        if (family.name != "spacemouse") continue;
        JogPlace place{.path = "/dev/hidraw2", .id = {0x256f, 0xc652}, .name = {}, .serial = {}};
        place.interface_number = 1;
        place.usage_page = 1;
        place.usage = 8;
        EXPECT_TRUE(reads(family, place));
        place.usage = 6;
        EXPECT_FALSE(reads(family, place)) << "its keyboard";
    }
}

}  // namespace
}  // namespace vantage
