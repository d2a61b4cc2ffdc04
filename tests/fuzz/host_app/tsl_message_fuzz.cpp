#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <string>

#include "host_app/control/ports/messages/tsl_message.h"

namespace vantage {
namespace {

void decode(std::span<const std::byte> bytes) {
    const auto displays = decode_tsl(bytes);
    if (!displays) return;
    for (const TslDisplay& display : *displays)
        if (display.address < 0 || display.address > 0xffff || display.tallies > 0xf) std::abort();
}

}  // namespace
}  // namespace vantage

/// The input is a datagram, and what a connection brings.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    vantage::decode(std::as_bytes(std::span(data, size)));
    vantage::TslStream stream;
    for (const std::string& message : stream.take({reinterpret_cast<const char*>(data), size})) {
        if (message.size() > vantage::most_tsl_bytes) std::abort();
        vantage::decode(std::as_bytes(std::span(message)));
    }
    if (stream.strays() > size) std::abort();
    return 0;
}
