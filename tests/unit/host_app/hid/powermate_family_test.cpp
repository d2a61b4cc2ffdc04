#include <cstring>

#include <gtest/gtest.h>
#include <linux/input.h>

#include "tests/unit/host_app/hid/decoded.h"

namespace vantage {
namespace {

std::vector<std::uint8_t> bytes_of(std::initializer_list<input_event> events) {
    std::vector<std::uint8_t> bytes(events.size() * sizeof(input_event));
    std::memcpy(bytes.data(), std::data(events), bytes.size());
    return bytes;
}
input_event event(std::uint16_t type, std::uint16_t code, int value) {
    input_event made{};
    made.type = type;
    made.code = code;
    made.value = value;
    return made;
}

TEST(PowerMateDecoder, ReadsTurnsAndPressesFromTheKernelsEvents) {
    const auto decoder = decoder_of("077d:0410");
    EXPECT_EQ(decoded(*decoder, bytes_of({event(EV_REL, REL_DIAL, -3), event(EV_SYN, 0, 0),
                                          event(EV_KEY, BTN_0, 1), event(EV_SYN, 0, 0)})),
              (std::vector<JogEvent>{step("jog", -3), press("press")}));
    EXPECT_EQ(decoded(*decoder, bytes_of({event(EV_KEY, BTN_0, 2)})), std::vector<JogEvent>{})
        << "the kernel's repetition";
    EXPECT_EQ(
        decoded(*decoder, bytes_of({event(EV_KEY, BTN_0, 0), event(EV_MSC, MSC_PULSELED, 9)})),
        std::vector<JogEvent>{let_go("press")});
}

TEST(PowerMateDecoder, RefusesPartsOfAnEvent) {
    const auto decoder = decoder_of("077d:0410");
    EXPECT_FALSE(takes(*decoder, std::vector<std::uint8_t>(sizeof(input_event) - 1)));
    EXPECT_FALSE(takes(*decoder, {}));
}

}  // namespace
}  // namespace vantage
