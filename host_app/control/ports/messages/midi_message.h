#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <tuple>

namespace vantage {

/// What a message of MIDI is about, of those that a surface's controls send.
enum class MidiKind {
    note,        ///< a pad: value is its velocity, 0 where it is let go
    controller,  ///< a fader, an encoder or a button
    bend,        ///< the pitch wheel, or a motor fader: it has no number, and 14 bits
};

/// A channel message as it came: nothing of it has been looked at yet.
struct MidiMessage {
    MidiKind kind = MidiKind::note;
    int channel = 1;  ///< 1 to 16
    int number = 0;   ///< 0 to 127
    int value = 0;    ///< 0 to 127; of a bend -8192 to 8191
    bool operator==(const MidiMessage&) const = default;
};

inline constexpr int midi_channels = 16, most_midi_value = 127;
inline constexpr int least_bend = -8192, most_bend = 8191;

/// Empty: every part of it is within what MIDI has. Else what is wrong, for people.
std::string fault_of(const MidiMessage& message);

/// A control of a surface, as a map names it: "note 36", "cc 7", "bend", with " ch 3" behind it
/// where only that channel is meant.
struct MidiControl {
    MidiKind kind = MidiKind::note;
    int number = 0;
    int channel = 0;  ///< 0: any
    auto operator<=>(const MidiControl&) const = default;
};
/// Nothing: it is no such name.
std::optional<MidiControl> parse_midi_control(std::string_view name);
std::string to_text(const MidiControl& control);

}  // namespace vantage
