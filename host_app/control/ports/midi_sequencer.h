#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "host_app/control/ports/messages/midi_message.h"

struct _snd_seq;

namespace vantage {

/// A port of ALSA's sequencer, which listens to the surfaces of this computer as they come and go.
/// Nothing of it leaves the computer.
class MidiSequencer {
  public:
    /// Where a surface is, as ALSA numbers it.
    struct Place {
        int client = 0, port = 0;
        auto operator<=>(const Place&) const = default;
    };
    struct Event {
        enum class Kind {
            plugged,    ///< it is listened to from now on
            unplugged,  ///< known or not
            message,
            foreign,  ///< something that no surface sends
        } kind = Kind::message;
        Place place;
        std::string name = {};  ///< of what was plugged in
        MidiMessage message = {};
    };

    /// Listens to surfaces whose name has `wanted` in it, in either case; "all": to every one but
    /// "Midi Through", which sends back what it gets. Throws Error, naming `what`, where there is
    /// no sequencer, or none that may be opened.
    MidiSequencer(std::string wanted, std::string what);

    /// Waits for so long at the most. Throws Error if the sequencer has failed.
    std::optional<Event> next(std::chrono::milliseconds most);
    /// False: it did not go out. A surface without lamps takes none.
    bool send(const Place& to, const MidiMessage& message);
    /// Times that events were lost because too many came.
    std::uint64_t overrun() const { return overrun_; }

  private:
    struct Close {
        void operator()(_snd_seq* sequencer) const;
    };
    /// Nothing: it is no surface that is wanted.
    std::optional<Event> plug(Place place);

    std::string wanted_, what_;
    std::unique_ptr<_snd_seq, Close> sequencer_;
    int own_client_ = -1, own_port_ = -1;
    std::optional<Place> looked_at_;  ///< while what was there at the start is gone through
    bool has_looked_ = false;
    std::uint64_t overrun_ = 0;
};

}  // namespace vantage
