#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>

#include "host_app/control/ports/messages/osc_message.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto messages = vantage::decode_osc(std::as_bytes(std::span(data, size)));
    if (!messages) return 0;
    for (const vantage::OscMessage& message : *messages)
        if (!message.address.starts_with('/')) std::abort();
    return 0;
}
