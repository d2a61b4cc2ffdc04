#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "common/base/files/embedded_text.h"
#include "host_app/control/hid/wheel_profile.h"
#include "host_app/control/table/lamp.h"

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

/// Encoding of a MIDI control's movement.
enum class MidiTravel {
    fader,          ///< keeps its position; a movement counts as steps
    stick,          ///< springs back to its centre; its distance from there sets the speed
    twos,           ///< encoder: 1 to 63 steps up, 127 to 65 steps down (two's complement)
    binary_offset,  ///< encoder: 65 to 127 up, 63 to 0 down
    sign_bit,       ///< encoder: 1 to 63 up, 65 to 127 down
    ends,           ///< encoder: 127 one step up, 0 one step down
};

struct MidiAxisMap {
    AxisMap map;
    MidiTravel travel = MidiTravel::fader;
    bool is_fine = false;       ///< 14 bits: the low seven are in the controller 32 above
    double travel_steps = 100;  ///< for a fader, from end to end
};

/// Lamp of the session that lights a pad when it is on.
struct MidiLampMap {
    MidiControl control;
    const Lamp* lamp = nullptr;
    int on = most_midi_value, off = 0;
};

/// Map of a MIDI surface's controls to commands, like a jog wheel's profile.
class MidiMap {
  public:
    /// Loads a file like hw_config/midi/standard.toml, or the built-in copy of it if the path is
    /// empty. Throws Error with file and line.
    static MidiMap load(const std::filesystem::path& path);
    static MidiMap read(std::string_view text, const std::filesystem::path& name);

    /// Button for the message; a map entry for its channel goes before one for any channel. Null if
    /// it is not mapped.
    const ButtonMap* find_button(const MidiMessage& message) const;
    const MidiAxisMap* find_axis(const MidiMessage& message) const;
    const std::vector<MidiLampMap>& lamps() const { return lamps_; }

  private:
    std::map<MidiControl, ButtonMap> buttons_;
    std::map<MidiControl, MidiAxisMap> axes_;
    std::vector<MidiLampMap> lamps_;
};

/// Built-in copies of the files in hw_config/midi.
std::span<const EmbeddedText> embedded_midi();

}  // namespace vantage
