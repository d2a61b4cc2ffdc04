#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "host_app/control/ports/messages/midi_map.h"

namespace vantage {

/// State of one MIDI surface: converts its messages to commands and computes the messages for its
/// lamps. Not thread-safe.
class MidiSurface {
  public:
    /// The map must outlive this object.
    explicit MidiSurface(const MidiMap& map) : map_(&map) {}

    struct Outcome {
        enum class Kind {
            heard,    ///< the message is valid; `call` is set if it is a command
            unknown,  ///< the message is not mapped
            malformed,
        } kind = Kind::heard;
        std::optional<CommandCall> call = {};
        std::string refusal = {};  ///< reason if the message is not valid
    };
    Outcome take(const MidiMessage& message);

    /// Input from all sticks that are off their rest position, for this time.
    FlightInput held(double dt_s) const;

    /// Messages for lamps that changed since the last call, and for controls that were touched,
    /// since many pads light by themselves.
    std::vector<MidiMessage> due(const ShowLamps& shown);
    /// Sends all lamps again at the next call.
    void forget_lamps() { lit_.clear(); }

  private:
    struct Held {
        AxisMap map;
        double position = 0;
    };
    Outcome press(const ButtonMap& map);
    Outcome move(const MidiAxisMap& axis, const MidiControl& control, int value, int most);

    const MidiMap* map_;
    std::map<MidiControl, double> faders_;  ///< positions, 0..1
    std::map<MidiControl, int> upper_;      ///< high halves of values with 14 bits
    std::map<MidiControl, Held> sticks_;    ///< sticks off their rest position
    std::set<MidiControl> pressed_;
    std::map<MidiControl, bool> lit_;
    bool is_storing_ = false;
};

}  // namespace vantage
