#include <cstddef>
#include <cstdint>
#include <string_view>

#include "common/base/error.h"
#include "host_app/control/ports/messages/midi_map.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    try {
        (void)vantage::MidiMap::read({reinterpret_cast<const char*>(data), size}, "midi.toml");
    } catch (const vantage::Error&) {
        // What a file may have wrong is said so.
    }
    return 0;
}
