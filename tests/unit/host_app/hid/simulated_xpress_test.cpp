#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "host_app/control/hid/jog_family.h"
#include "host_app/control/hid/simulated_wheel.h"
#include "tests/support/thrown_sentence.h"
#include "tests/unit/host_app/hid/decoded.h"

namespace vantage {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// What `vantage` understands of a line.
std::vector<std::string> understood(SimulatedXpress& wheel, JogDecoder& decoder,
                                    const std::string& line) {
    std::vector<std::string> texts;
    for (const SimulatedXpress::Report& report : wheel.reports_of(line)) {
        std::vector<JogEvent> events;
        EXPECT_TRUE(decoder.decode(report, events));
        for (const JogEvent& event : events)
            texts.push_back(fmt::format("{} {:.2f}", event.control, event.value));
    }
    return texts;
}

TEST(SimulatedXpress, IsUnderstoodAsTheRealOne) {
    const auto decoder = make_known_decoder({SimulatedXpress::vendor, SimulatedXpress::product});
    ASSERT_TRUE(decoder);
    SimulatedXpress wheel;
    EXPECT_THAT(understood(wheel, *decoder, "jog 2"), ElementsAre("jog 1.00", "jog 1.00"));
    EXPECT_THAT(understood(wheel, *decoder, "jog -3"),
                ElementsAre("jog -1.00", "jog -1.00", "jog -1.00"))
        << "below zero its counter wraps";
    EXPECT_THAT(understood(wheel, *decoder, "shuttle 7"), ElementsAre("shuttle 1.00"));
    EXPECT_THAT(understood(wheel, *decoder, "b5"), ElementsAre("b5 1.00", "b5 0.00"));
    EXPECT_THAT(understood(wheel, *decoder, "shuttle 0"), ElementsAre("shuttle 0.00"));
    EXPECT_THAT(understood(wheel, *decoder, "jog 0"), ElementsAre());
}

TEST(SimulatedXpress, NamesWordsThatItDoesNotKnow) {
    SimulatedXpress wheel;
    for (const char* line : {"", "jump", "b0", "b6", "b12"})
        EXPECT_THAT(thrown_sentence([&] { wheel.reports_of(line); }), HasSubstr("words are: jog 3"))
            << line;
    EXPECT_THAT(thrown_sentence([&] { wheel.reports_of("shuttle 8"); }), HasSubstr("from -7 to 7"));
    EXPECT_THAT(thrown_sentence([&] { wheel.reports_of("jog"); }), HasSubstr("from -100 to 100"));
    EXPECT_THAT(thrown_sentence([&] { wheel.reports_of("jog 1 2"); }), HasSubstr("nothing comes"));
}

}  // namespace
}  // namespace vantage
