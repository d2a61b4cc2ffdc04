#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace vantage {

/// What a message of TSL's UMD protocol says of one display: a bit for each of its tallies, the
/// lowest is tally 1. Of version 5.0 tally 1 is red and tally 2 green, whichever lamp of the
/// display it is.
struct TslDisplay {
    int address = 0;
    unsigned tallies = 0;
};

/// Of version 5.0, by its standard.
inline constexpr std::size_t most_tsl_bytes = 2048;

/// Of version 5.0: the display address that means every one.
inline constexpr int every_tsl_display = 0xffff;

/// The displays of a datagram: one or more messages of version 3.1 or 4.0 (18 bytes, which begin
/// with 0x80 + address) or 5.0, which may be wrapped as for TCP. Nothing: it is none of these.
std::optional<std::vector<TslDisplay>> decode_tsl(std::span<const std::byte> datagram);

}  // namespace vantage
