#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>

#include "host_app/ltc/ltc_sound.h"

/// Sound that anybody may send: every byte pair is a sample.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace vantage;
    SoundBlock sound;
    for (std::size_t i = 0; i + 1 < size; i += 2) {
        std::int16_t value = 0;
        std::memcpy(&value, data + i, sizeof value);
        sound.samples.insert(sound.samples.end(), sound_channels,
                             static_cast<float>(value) / 32768);
    }
    LtcReader reader;
    for (const LtcReading& reading : reader.hear(sound)) {
        const SmpteCount count = count_of(reading);
        const auto frame = count.frame_of(reading.code);
        if (!frame || count.code_of(*frame) != reading.code ||
            SmpteCode::parse(reading.code.text()) != reading.code)
            std::abort();
    }
    (void)SmpteCode::parse({reinterpret_cast<const char*>(data), size});
    return 0;
}
