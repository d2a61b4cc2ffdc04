#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "common/wire/link_message.h"
#include "tests/fuzz/seeds/input_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace vantage;
    const auto bytes = std::as_bytes(std::span(data, size));
    // What is understood has to survive the way back, or two ends would disagree about it.
    expect_result_or_error([&] {
        const HostMessage message = decode_host_message(bytes);
        if (decode_host_message(encode(message)) != message) std::abort();
    });
    expect_result_or_error([&] {
        const RigMessage message = decode_rig_message(bytes);
        if (decode_rig_message(encode(message)).counters != message.counters) std::abort();
    });
    return 0;
}
