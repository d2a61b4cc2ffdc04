#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "common/datagrams/frame_packets.h"
#include "tests/fuzz/seeds/input_file.h"

// Packets in a row, each behind a byte: how much it is shorter than a full one.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace vantage;
    constexpr const char* passphrase = "a passphrase of a seed";
    FrameJoiner joiner;
    std::span<const std::byte> rest = std::as_bytes(std::span(data, size));
    while (!rest.empty()) {
        const std::size_t shorter = std::to_integer<std::size_t>(rest.front()) * 6;
        rest = rest.subspan(1);
        const std::size_t bytes =
            std::min(rest.size(), packet_bytes + 1 - std::min(packet_bytes, shorter));
        const std::span<const std::byte> packet = rest.first(bytes);
        rest = rest.subspan(bytes);
        expect_result_or_error([&] {
            const auto message = joiner.take(packet);
            if (!message) return;
            if (message->size() > max_datagram_message_bytes + packet_bytes) std::abort();
            expect_result_or_error([&] {
                const FrameParts parts = split_message(*message, passphrase);
                // The parts of an accepted message make the same message again.
                if (join_parts(parts, passphrase) != *message) std::abort();
            });
        });
    }
    return 0;
}
