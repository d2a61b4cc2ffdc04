#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>

#include "host_app/control/ports/tsl_message.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto displays = vantage::decode_tsl(std::as_bytes(std::span(data, size)));
    if (!displays) return 0;
    for (const vantage::TslDisplay& display : *displays)
        if (display.address < 0 || display.address > 0xffff || display.tallies > 0xf) std::abort();
    return 0;
}
