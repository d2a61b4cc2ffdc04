#include "host_app/control/ports/midi_sequencer.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <limits>

#include <alsa/asoundlib.h>
#include <unistd.h>

#include "common/base/error.h"
#include "host_app/sound/alsa_capture.h"

namespace vantage {
namespace {

constexpr const char* sequencer_device = "/dev/snd/seq";
constexpr const char* every_surface = "all";
constexpr const char* echo_client = "midi through";
constexpr unsigned readable = SND_SEQ_PORT_CAP_READ | SND_SEQ_PORT_CAP_SUBS_READ;

std::string lower_case(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

/// Converts a channel number from the wire, which counts from 0, to one that counts from 1.
int counted_from_one(unsigned number) {
    return static_cast<int>(std::min(number, unsigned{std::numeric_limits<short>::max()})) + 1;
}

int as_signed(unsigned number) {
    return static_cast<int>(std::min(number, unsigned{std::numeric_limits<int>::max()}));
}

}  // namespace

void MidiSequencer::Close::operator()(_snd_seq* sequencer) const { snd_seq_close(sequencer); }

MidiSequencer::MidiSequencer(std::string wanted, std::string what)
    : wanted_(lower_case(std::move(wanted))), what_(std::move(what)) {
    keep_alsa_log();
    if (access(sequencer_device, F_OK) != 0)
        fail("{}: this computer has no MIDI sequencer ({}): load it with `sudo modprobe snd-seq`",
             what_, sequencer_device);
    if (access(sequencer_device, R_OK | W_OK) != 0)
        fail("{}: {} may not be opened by this user: put him into the group audio and log in again",
             what_, sequencer_device);
    snd_seq_t* opened = nullptr;
    if (const int error = snd_seq_open(&opened, "default", SND_SEQ_OPEN_DUPLEX, SND_SEQ_NONBLOCK);
        error < 0)
        fail("{}: the MIDI sequencer cannot be opened: {}", what_, snd_strerror(error));
    sequencer_.reset(opened);
    snd_seq_set_client_name(opened, "Vantage");
    // Clocks, aftertouch and dumps control nothing: the kernel filters them out, with its own
    // messages about subscriptions. Setting the first filter enables filtering.
    for (const int kind :
         {SND_SEQ_EVENT_NOTEON, SND_SEQ_EVENT_NOTEOFF, SND_SEQ_EVENT_CONTROLLER,
          SND_SEQ_EVENT_PITCHBEND, SND_SEQ_EVENT_PORT_START, SND_SEQ_EVENT_PORT_EXIT})
        snd_seq_set_client_event_filter(opened, kind);
    own_client_ = snd_seq_client_id(opened);
    own_port_ = snd_seq_create_simple_port(
        opened, "surfaces", SND_SEQ_PORT_CAP_WRITE | SND_SEQ_PORT_CAP_SUBS_WRITE,
        SND_SEQ_PORT_TYPE_MIDI_GENERIC | SND_SEQ_PORT_TYPE_APPLICATION);
    const int connected = own_port_ < 0
                              ? own_port_
                              : snd_seq_connect_from(opened, own_port_, SND_SEQ_CLIENT_SYSTEM,
                                                     SND_SEQ_PORT_SYSTEM_ANNOUNCE);
    if (connected < 0)
        fail("{}: the MIDI sequencer gives no port: {}", what_, snd_strerror(connected));
}

std::optional<MidiSequencer::Event> MidiSequencer::plug(Place place) {
    if (place.client == own_client_ || place.client == SND_SEQ_CLIENT_SYSTEM) return std::nullopt;
    snd_seq_client_info_t* client = nullptr;
    snd_seq_client_info_alloca(&client);
    snd_seq_port_info_t* port = nullptr;
    snd_seq_port_info_alloca(&port);
    if (snd_seq_get_any_client_info(sequencer_.get(), place.client, client) < 0 ||
        snd_seq_get_any_port_info(sequencer_.get(), place.client, place.port, port) < 0)
        return std::nullopt;
    const std::string name = snd_seq_client_info_get_name(client), folded = lower_case(name);
    const bool is_wanted = wanted_ == every_surface ? folded != echo_client
                                                    : folded.find(wanted_) != std::string::npos;
    if (!is_wanted || (snd_seq_port_info_get_capability(port) & readable) != readable)
        return std::nullopt;
    const int connected =
        snd_seq_connect_from(sequencer_.get(), own_port_, place.client, place.port);
    // The port may have been found twice, by the scan and by its announcement.
    if (connected < 0) return std::nullopt;
    return Event{Event::Kind::plugged, place, name, {}};
}

std::optional<MidiSequencer::Event> MidiSequencer::next(std::chrono::milliseconds most) {
    snd_seq_client_info_t* client = nullptr;
    snd_seq_client_info_alloca(&client);
    snd_seq_port_info_t* port = nullptr;
    snd_seq_port_info_alloca(&port);
    // Devices that are already plugged in come first, one at a time.
    while (!has_looked_) {
        if (!looked_at_) looked_at_ = Place{SND_SEQ_CLIENT_SYSTEM, -1};
        snd_seq_port_info_set_client(port, looked_at_->client);
        snd_seq_port_info_set_port(port, looked_at_->port);
        if (snd_seq_query_next_port(sequencer_.get(), port) >= 0) {
            looked_at_->port = snd_seq_port_info_get_port(port);
            if (std::optional<Event> event = plug(*looked_at_)) return event;
            continue;
        }
        snd_seq_client_info_set_client(client, looked_at_->client);
        has_looked_ = snd_seq_query_next_client(sequencer_.get(), client) < 0;
        if (!has_looked_) looked_at_ = Place{snd_seq_client_info_get_client(client), -1};
    }
    pollfd waiting{};
    snd_seq_poll_descriptors(sequencer_.get(), &waiting, 1, POLLIN);
    if (snd_seq_event_input_pending(sequencer_.get(), 0) == 0 &&
        poll(&waiting, 1, static_cast<int>(most.count())) <= 0)
        return std::nullopt;
    snd_seq_event_t* came = nullptr;
    const int error = snd_seq_event_input(sequencer_.get(), &came);
    if (error == -ENOSPC) ++overrun_;
    if (error == -ENOSPC || error == -EAGAIN) return std::nullopt;
    if (error < 0 || !came)
        fail("{}: the MIDI sequencer has failed: {}", what_, snd_strerror(error));

    Event event{Event::Kind::message, {came->source.client, came->source.port}, {}, {}};
    const snd_seq_ev_note& note = came->data.note;
    const snd_seq_ev_ctrl& control = came->data.control;
    switch (came->type) {
        case SND_SEQ_EVENT_NOTEON:
        case SND_SEQ_EVENT_NOTEOFF:
            event.message = {MidiKind::note, note.channel + 1, note.note,
                             came->type == SND_SEQ_EVENT_NOTEON ? note.velocity : 0};
            return event;
        case SND_SEQ_EVENT_CONTROLLER:
            event.message = {MidiKind::controller, counted_from_one(control.channel),
                             as_signed(control.param), control.value};
            return event;
        case SND_SEQ_EVENT_PITCHBEND:
            event.message = {MidiKind::bend, counted_from_one(control.channel), 0, control.value};
            return event;
        case SND_SEQ_EVENT_PORT_START:
        case SND_SEQ_EVENT_PORT_EXIT: {
            if (came->source.client != SND_SEQ_CLIENT_SYSTEM) break;
            const Place place{came->data.addr.client, came->data.addr.port};
            if (came->type == SND_SEQ_EVENT_PORT_START) return plug(place);
            return Event{Event::Kind::unplugged, place, {}, {}};
        }
        default:
            break;
    }
    event.kind = Event::Kind::foreign;
    return event;
}

bool MidiSequencer::send(const Place& to, const MidiMessage& message) {
    snd_seq_event_t event;
    snd_seq_ev_clear(&event);
    snd_seq_ev_set_source(&event, static_cast<unsigned char>(own_port_));
    snd_seq_ev_set_dest(&event, static_cast<unsigned char>(to.client),
                        static_cast<unsigned char>(to.port));
    snd_seq_ev_set_direct(&event);
    const int channel = message.channel - 1;
    if (message.kind == MidiKind::note)
        snd_seq_ev_set_noteon(&event, static_cast<unsigned char>(channel),
                              static_cast<unsigned char>(message.number),
                              static_cast<unsigned char>(message.value));
    else
        snd_seq_ev_set_controller(&event, static_cast<unsigned char>(channel),
                                  static_cast<unsigned>(message.number), message.value);
    const int error = snd_seq_event_output_direct(sequencer_.get(), &event);
    // A device that accepts nothing is not asked again.
    return error >= 0 || error == -EPERM || error == -ENOENT || error == -EINVAL;
}

}  // namespace vantage
