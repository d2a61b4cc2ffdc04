#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <tuple>

namespace vantage {

/// Kinds of MIDI messages that the controls of a surface send.
enum class MidiKind {
    note,        ///< pad: the value is its velocity, 0 when released
    controller,  ///< fader, encoder or button
    bend,        ///< pitch wheel or motor fader: no number, 14 bits
};

/// MIDI channel message as received, not yet checked.
struct MidiMessage {
    MidiKind kind = MidiKind::note;
    int channel = 1;  ///< 1 to 16
    int number = 0;   ///< 0 to 127
    int value = 0;    ///< 0 to 127; for a bend -8192 to 8191
    bool operator==(const MidiMessage&) const = default;
};

inline constexpr int midi_channels = 16, most_midi_value = 127;
inline constexpr int least_bend = -8192, most_bend = 8191;

/// Error text for a message with a part outside MIDI's limits; empty if it is valid.
std::string fault_of(const MidiMessage& message);

/// Control of a surface, as a map names it: "note 36", "cc 7", "bend", with the suffix " ch 3" for
/// one channel only.
struct MidiControl {
    MidiKind kind = MidiKind::note;
    int number = 0;
    int channel = 0;  ///< 0: any channel
    auto operator<=>(const MidiControl&) const = default;
};
/// Parses the name of a control; empty if it is not valid.
std::optional<MidiControl> parse_midi_control(std::string_view name);
std::string to_text(const MidiControl& control);

}  // namespace vantage
