#pragma once

#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/files/embedded_text.h"
#include "host_app/control/hid/wheel_profile.h"
#include "host_app/control/ports/messages/midi_message.h"
#include "host_app/control/table/lamp.h"

namespace vantage {

/// How a control tells where it is.
enum class MidiTravel {
    fader,          ///< stays where it is put: what it is moved by counts as steps
    stick,          ///< springs back to its middle: the further out, the faster
    twos,           ///< an encoder: 1 to 63 steps on, 127 to 65 back (two's complement)
    binary_offset,  ///< 65 to 127 on, 63 to 0 back
    sign_bit,       ///< 1 to 63 on, 65 to 127 back
    ends,           ///< 127 one step on, 0 one back
};

struct MidiAxisMap {
    AxisMap map;
    MidiTravel travel = MidiTravel::fader;
    bool is_fine = false;       ///< 14 bits: the controller 32 above has the lower seven
    double travel_steps = 100;  ///< of a fader, from end to end
};

/// What lights a pad: a lamp that is on or off.
struct MidiLampMap {
    MidiControl control;
    const Lamp* lamp = nullptr;
    int on = most_midi_value, off = 0;
};

/// What the controls of a surface do, as a jog wheel's file says it of a wheel.
class MidiMap {
  public:
    /// Reads a file like hw_config/midi/standard.toml, or that one itself where there is no path.
    /// Throws Error with file and line for whatever does not fit.
    static MidiMap load(const std::filesystem::path& path);
    static MidiMap read(std::string_view text, const std::filesystem::path& name);

    /// Of the message's channel before any. Null: it is mapped to nothing.
    const ButtonMap* find_button(const MidiMessage& message) const;
    const MidiAxisMap* find_axis(const MidiMessage& message) const;
    const std::vector<MidiLampMap>& lamps() const { return lamps_; }

  private:
    std::map<MidiControl, ButtonMap> buttons_;
    std::map<MidiControl, MidiAxisMap> axes_;
    std::vector<MidiLampMap> lamps_;
};

/// The files of hw_config/midi as they were built in.
std::span<const EmbeddedText> embedded_midi();

}  // namespace vantage
