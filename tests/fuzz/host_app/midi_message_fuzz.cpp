#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>

#include "host_app/control/ports/midi_surface.h"

/// Messages of seven bytes: kind, channel, number and a value of four bytes, any of them wrong.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace vantage;
    static const MidiMap map = MidiMap::load({});
    constexpr std::size_t message_bytes = 7;
    MidiSurface surface(map);
    for (; size >= message_bytes; data += message_bytes, size -= message_bytes) {
        MidiMessage message;
        message.kind = static_cast<MidiKind>(data[0] % 3);
        message.channel = static_cast<std::int8_t>(data[1]);
        message.number = static_cast<std::int8_t>(data[2]);
        std::int32_t value = 0;
        std::memcpy(&value, data + 3, sizeof value);
        message.value = value;
        const MidiSurface::Outcome outcome = surface.take(message);
        const bool is_heard = outcome.kind == MidiSurface::Outcome::Kind::heard;
        if (is_heard != outcome.refusal.empty() || (!is_heard && outcome.call)) std::abort();
        if (outcome.call && !(std::abs(outcome.call->argument) <= most_steps)) std::abort();
        if (!std::isfinite(surface.held(1).shuttle_s)) std::abort();
        for (const MidiMessage& lamp : surface.due({}))
            if (!fault_of(lamp).empty()) std::abort();
    }
    return 0;
}
