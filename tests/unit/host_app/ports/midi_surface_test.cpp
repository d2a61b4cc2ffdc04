#include "host_app/control/ports/midi_surface.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/thrown_sentence.h"

namespace vantage {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using Outcome = MidiSurface::Outcome::Kind;

MidiMap midi_map(const std::string& text) {
    return MidiMap::read("version = 1\n" + text, "pads.toml");
}
MidiMessage note(int number, int velocity, int channel = 1) {
    return {MidiKind::note, channel, number, velocity};
}
MidiMessage cc(int number, int value, int channel = 1) {
    return {MidiKind::controller, channel, number, value};
}
/// "shot 3" of what a message asks for; empty: nothing.
std::string asked(const MidiSurface::Outcome& outcome) {
    return outcome.call ? fmt::format("{} {}", outcome.call->command->name, outcome.call->argument)
                        : "";
}

TEST(MidiControl, IsNamedByKindNumberAndChannel) {
    EXPECT_EQ(parse_midi_control("note 36"), (MidiControl{MidiKind::note, 36, 0}));
    EXPECT_EQ(parse_midi_control("cc 127 ch 16"), (MidiControl{MidiKind::controller, 127, 16}));
    EXPECT_EQ(parse_midi_control("bend"), (MidiControl{MidiKind::bend, 0, 0}));
    EXPECT_EQ(parse_midi_control("bend ch 2"), (MidiControl{MidiKind::bend, 0, 2}));
    for (const char* wrong : {"", "note", "note ", "note 128", "note -1", "cc 1 ch 0", "cc 1 ch 17",
                              "cc 1 ", "cc 1 ch 2 ", "bend 3", "Note 3", "note 3x"})
        EXPECT_FALSE(parse_midi_control(wrong)) << wrong;
    for (const char* name : {"note 36", "cc 7 ch 3", "bend", "bend ch 16"})
        EXPECT_EQ(to_text(*parse_midi_control(name)), name);
}

TEST(MidiMap, IsReadStrictly) {
    const auto refusal = [](const std::string& text) {
        return thrown_sentence([&] { (void)midi_map(text); });
    };
    EXPECT_EQ(refusal("[buttons]\n\"note 3\" = \"live\"\n"), "");
    EXPECT_THAT(refusal("[buttons]\n\"not 3\" = \"live\"\n"), HasSubstr("pads.toml:3"));
    EXPECT_THAT(refusal("[buttons]\n\"note 3\" = \"lve\"\n"), HasSubstr("'live'"));
    EXPECT_THAT(refusal("[buttons]\nbend = \"live\"\n"), HasSubstr("no button"));
    EXPECT_THAT(refusal("[buttons]\n\"note 3\" = \"live\"\n\"note 03\" = \"take\"\n"),
                HasSubstr("a second time"));
    EXPECT_THAT(refusal("[axes.\"note 3\"]\naction = \"orbit\"\n"), HasSubstr("no axis"));
    EXPECT_THAT(refusal("[axes.\"cc 3\"]\naction = \"shuttle\"\n"), HasSubstr("without a rest"));
    EXPECT_THAT(refusal("[axes.\"cc 3\"]\naction = \"orbit\"\nbits = 12\n"), HasSubstr("7 or 14"));
    EXPECT_THAT(refusal("[axes.\"cc 40\"]\naction = \"orbit\"\nbits = 14\n"), HasSubstr("0 to 31"));
    EXPECT_THAT(refusal("[axes.\"cc 3\"]\naction = \"orbit\"\nencoding = \"sign\"\n"),
                HasSubstr("encoder"));
    EXPECT_THAT(refusal("[axes.\"cc 3\"]\naction = \"orbit\"\nkind = \"encoder\"\nbits = 14\n"),
                HasSubstr("14 bits"));
    EXPECT_THAT(refusal("[lamps.\"note 3\"]\nlamp = \"speed\"\n"), HasSubstr("on or off"));
    EXPECT_THAT(refusal("[lamps.\"note 3\"]\nlamp = \"hodl\"\n"), HasSubstr("hold"));
    EXPECT_THAT(refusal("[pads]\n"), HasSubstr("pads"));
}

TEST(MidiMap, OfVantageItselfFits) {
    const MidiMap map = MidiMap::load({});
    ASSERT_NE(map.find_button(note(44, 1)), nullptr);
    EXPECT_STREQ(map.find_button(note(44, 1))->call.command->name, "live");
    EXPECT_EQ(map.find_axis(cc(16, 1))->travel, MidiTravel::twos);
    EXPECT_EQ(map.find_button(note(0, 1)), nullptr);
}

TEST(MidiSurface, GivesACommandOnceAPress) {
    const MidiMap map = midi_map(
        "[buttons]\n\"note 3\" = \"shot 3\"\n\"note 4\" = \"store\"\n\"cc 5\" = \"live\"\n"
        "\"note 3 ch 2\" = \"take\"\n");
    MidiSurface surface(map);
    EXPECT_EQ(asked(surface.take(note(3, 90))), "shot 3");
    EXPECT_EQ(asked(surface.take(note(3, 90))), "") << "it was not let go";
    EXPECT_EQ(asked(surface.take(note(3, 0))), "");
    EXPECT_EQ(asked(surface.take(note(4, 1))), "");
    EXPECT_EQ(asked(surface.take(note(3, 1))), "store 3");
    EXPECT_EQ(asked(surface.take(note(3, 1, 2))), "take 0") << "its own channel comes first";
    EXPECT_EQ(asked(surface.take(cc(5, 63))), "");
    EXPECT_EQ(asked(surface.take(cc(5, 64))), "live 0");
    EXPECT_EQ(asked(surface.take(cc(5, 127))), "");
    EXPECT_EQ(surface.take(note(9, 1)).kind, Outcome::unknown);
}

TEST(MidiSurface, RefusesWhatMidiDoesNotHave) {
    const MidiMap map =
        midi_map("[buttons]\n\"note 3\" = \"live\"\n[axes.bend]\naction = \"orbit\"\n");
    MidiSurface surface(map);
    for (const MidiMessage& wrong :
         {note(3, 128), note(3, -1), note(128, 1), note(-1, 1), note(3, 1, 0), note(3, 1, 17),
          MidiMessage{MidiKind::bend, 1, 0, 8192}, MidiMessage{MidiKind::bend, 1, 0, -8193}}) {
        const MidiSurface::Outcome outcome = surface.take(wrong);
        EXPECT_EQ(outcome.kind, Outcome::malformed);
        EXPECT_FALSE(outcome.call);
        EXPECT_THAT(outcome.refusal, HasSubstr("none of"));
    }
    EXPECT_FALSE(surface.held(1).is_any());
}

TEST(MidiSurface, CountsEncodersInEveryEncoding) {
    const MidiMap map = midi_map(
        "[axes.\"cc 1\"]\naction = \"orbit\"\nkind = \"encoder\"\n"
        "[axes.\"cc 2\"]\naction = \"orbit\"\nkind = \"encoder\"\nencoding = \"offset\"\n"
        "[axes.\"cc 3\"]\naction = \"orbit\"\nkind = \"encoder\"\nencoding = \"sign\"\n"
        "sensitivity = 2\ninverted = true\n");
    MidiSurface surface(map);
    EXPECT_EQ(asked(surface.take(cc(1, 2))), "orbit 2");
    EXPECT_EQ(asked(surface.take(cc(1, 127))), "orbit -1");
    EXPECT_EQ(asked(surface.take(cc(1, 0))), "");
    EXPECT_EQ(asked(surface.take(cc(2, 67))), "orbit 3");
    EXPECT_EQ(asked(surface.take(cc(2, 63))), "orbit -1");
    EXPECT_EQ(asked(surface.take(cc(3, 1))), "orbit -2");
    EXPECT_EQ(asked(surface.take(cc(3, 66))), "orbit 4");
}

TEST(MidiSurface, CountsTheClicksOfAnEncoderThatSendsItsEnds) {
    const MidiMap map =
        midi_map("[axes.\"cc 1\"]\naction = \"orbit\"\nkind = \"encoder\"\nencoding = \"127/0\"\n");
    MidiSurface surface(map);
    EXPECT_EQ(asked(surface.take(cc(1, 127))), "orbit 1");
    EXPECT_EQ(asked(surface.take(cc(1, 0))), "orbit -1");
}

TEST(MidiSurface, RefusesAClickThatWouldLeap) {
    const MidiMap map = midi_map(
        "[axes.\"cc 1\"]\naction = \"orbit\"\nkind = \"encoder\"\n"
        "[axes.\"cc 2\"]\naction = \"orbit\"\nkind = \"encoder\"\nencoding = \"offset\"\n"
        "[axes.\"cc 3\"]\naction = \"orbit\"\nkind = \"encoder\"\nencoding = \"sign\"\n"
        "[axes.\"cc 4\"]\naction = \"orbit\"\nkind = \"encoder\"\nencoding = \"127/0\"\n");
    MidiSurface surface(map);
    // Of encoders that send 63 and 65, 127 and 0, 1 and 127, or 1 and 65. An encoder that sends 0
    // in another encoding would turn in one direction only.
    for (const MidiMessage& click :
         {cc(1, 63), cc(1, 65), cc(1, 0), cc(2, 127), cc(2, 0), cc(2, 1), cc(2, 64), cc(3, 127),
          cc(3, 63), cc(3, 0), cc(3, 64), cc(4, 1), cc(4, 63), cc(4, 65)}) {
        const MidiSurface::Outcome outcome = surface.take(click);
        EXPECT_EQ(outcome.kind, Outcome::malformed) << click.value;
        EXPECT_EQ(asked(outcome), "");
        EXPECT_THAT(outcome.refusal, HasSubstr("encoding"));
    }
}

TEST(MidiSurface, CountsWhatAFaderMovesInSevenAndFourteenBits) {
    const MidiMap map = midi_map(
        "[axes.\"cc 1\"]\naction = \"zoom\"\ntravel_steps = 127\n"
        "[axes.\"cc 2\"]\naction = \"zoom\"\nbits = 14\ntravel_steps = 100\n");
    MidiSurface surface(map);
    EXPECT_EQ(asked(surface.take(cc(1, 100))), "") << "it only tells where it stands";
    EXPECT_NEAR(surface.take(cc(1, 97)).call->argument, -3, 1e-9);
    EXPECT_EQ(asked(surface.take(cc(34, 5))), "") << "of what has no upper half yet";
    EXPECT_EQ(asked(surface.take(cc(2, 0))), "") << "half of a value";
    EXPECT_EQ(asked(surface.take(cc(34, 0))), "");
    EXPECT_NEAR(surface.take(cc(34, 1)).call->argument, 100.0 / 16383, 1e-9);
    EXPECT_EQ(asked(surface.take(cc(2, 127))), "");
    EXPECT_NEAR(surface.take(cc(34, 127)).call->argument, 100.0 * 16382 / 16383, 1e-9);
}

TEST(MidiSurface, HoldsASpeedAsLongAsAStickIsOffItsRest) {
    const MidiMap map = midi_map(
        "[axes.bend]\naction = \"shuttle\"\n[axes.\"cc 1\"]\naction = \"orbit\"\n"
        "kind = \"stick\"\n");
    MidiSurface surface(map);
    EXPECT_EQ(surface.take({MidiKind::bend, 1, 0, most_bend}).kind, Outcome::heard);
    EXPECT_NEAR(surface.held(0.5).shuttle_s, 1, 1e-9) << "2x, half a second";
    EXPECT_EQ(surface.take({MidiKind::bend, 1, 0, 0}).kind, Outcome::heard);
    EXPECT_FALSE(surface.held(0.5).is_any());
    (void)surface.take(cc(1, 0));
    const double back = surface.held(1).orbit_azimuth_rad;
    (void)surface.take(cc(1, 127));
    EXPECT_NEAR(surface.held(1).orbit_azimuth_rad, -back, 1e-9);
    EXPECT_NE(back, 0);
    (void)surface.take(cc(1, 64));
    EXPECT_FALSE(surface.held(1).is_any());
}

TEST(MidiSurface, IsLitByWhatChangedAndAgainWhereItWasTouched) {
    const MidiMap map = midi_map(
        "[buttons]\n\"note 3\" = \"freeze\"\n[lamps.\"note 3\"]\nlamp = \"hold\"\non = 5\n"
        "off = 1\n[lamps.\"cc 9 ch 4\"]\nlamp = \"programme\"\n");
    MidiSurface surface(map);
    ShowLamps shown;
    EXPECT_THAT(surface.due(shown), testing::UnorderedElementsAre(note(3, 1), cc(9, 0, 4)));
    EXPECT_THAT(surface.due(shown), IsEmpty());
    shown.programme_tally = true;
    EXPECT_THAT(surface.due(shown), ElementsAre(cc(9, 127, 4)));
    shown.hold = true;
    EXPECT_THAT(surface.due(shown), ElementsAre(note(3, 5)));
    (void)surface.take(note(3, 0, 7));
    EXPECT_THAT(surface.due(shown), ElementsAre(note(3, 5))) << "the pad has lit by itself";
    surface.forget_lamps();
    EXPECT_EQ(surface.due(shown).size(), 2u);
}

}  // namespace
}  // namespace vantage
