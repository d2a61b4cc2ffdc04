#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "host_app/control/ports/messages/midi_map.h"

namespace vantage {

/// One surface that is plugged in: what its messages come to, and what lights it.
class MidiSurface {
  public:
    /// The map must outlive it.
    explicit MidiSurface(const MidiMap& map) : map_(&map) {}

    struct Outcome {
        enum class Kind {
            heard,    ///< it fits; `call` where it asks for something now
            unknown,  ///< mapped to nothing
            malformed,
        } kind = Kind::heard;
        std::optional<CommandCall> call = {};
        std::string refusal = {};  ///< of what was not heard
    };
    Outcome take(const MidiMessage& message);

    /// What the sticks that are off their rest ask for in this time.
    FlightInput held(double dt_s) const;

    /// What is to be sent for these lamps: those that changed since the last call, and those of
    /// controls that were touched, since many pads light by themselves.
    std::vector<MidiMessage> due(const ShowLamps& shown);
    /// All of them are due again.
    void forget_lamps() { lit_.clear(); }

  private:
    struct Held {
        AxisMap map;
        double position = 0;
    };
    Outcome press(const ButtonMap& map);
    Outcome move(const MidiAxisMap& axis, const MidiControl& control, int value, int most);

    const MidiMap* map_;
    std::map<MidiControl, double> faders_;  ///< where they are, 0..1
    std::map<MidiControl, int> upper_;      ///< halves of what has 14 bits
    std::map<MidiControl, Held> sticks_;    ///< off their rest
    std::set<MidiControl> pressed_;
    std::map<MidiControl, bool> lit_;
    bool is_storing_ = false;
};

}  // namespace vantage
