#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "host_app/control/ports/messages/midi_map.h"

struct _snd_seq;

namespace vantage {

/// Port of ALSA's sequencer that receives from this computer's MIDI surfaces as they are plugged in
/// and out. It uses no network.
class MidiSequencer {
  public:
    /// ALSA address of a surface.
    struct Place {
        int client = 0, port = 0;
        auto operator<=>(const Place&) const = default;
    };
    struct Event {
        enum class Kind {
            plugged,    ///< the port receives from it from now on
            unplugged,  ///< any client, known or not
            message,
            foreign,  ///< a message that no surface sends
        } kind = Kind::message;
        Place place;
        std::string name = {};  ///< of the surface that was plugged in
        MidiMessage message = {};
    };

    /// Receives from surfaces whose name contains `wanted`, case-insensitive; "all" means all but
    /// "Midi Through", which echoes its input. Throws Error, with `what` as the port's name, if
    /// there is no sequencer or this user may not open it.
    MidiSequencer(std::string wanted, std::string what);

    /// Waits for the next event for at most this time. Throws Error if the sequencer has failed.
    std::optional<Event> next(std::chrono::milliseconds most);
    /// Returns false if the message was not sent. Surfaces without lamps accept none.
    bool send(const Place& to, const MidiMessage& message);
    /// Number of times that events were lost because too many arrived.
    std::uint64_t overrun() const { return overrun_; }

  private:
    struct Close {
        void operator()(_snd_seq* sequencer) const;
    };
    /// Connects a port; empty if it is not a wanted surface.
    std::optional<Event> plug(Place place);

    std::string wanted_, what_;
    std::unique_ptr<_snd_seq, Close> sequencer_;
    int own_client_ = -1, own_port_ = -1;
    std::optional<Place> looked_at_;  ///< position of the initial scan; empty when it is done
    bool has_looked_ = false;
    std::uint64_t overrun_ = 0;
};

}  // namespace vantage
