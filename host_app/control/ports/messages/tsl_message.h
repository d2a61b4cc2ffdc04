#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace vantage {

/// State of one display in a TSL UMD message: one bit per tally, the lowest is tally 1. In version
/// 5.0 tally 1 is red and tally 2 is green on any lamp of the display.
struct TslDisplay {
    int address = 0;
    unsigned tallies = 0;
};

/// Longest message of version 5.0, by its standard.
inline constexpr std::size_t most_tsl_bytes = 2048;

/// Broadcast address of displays in version 5.0.
inline constexpr int every_tsl_display = 0xffff;

/// Decodes a datagram: one or more messages of version 3.1 or 4.0 (18 bytes, which begin with 0x80
/// + address) or 5.0, with or without its TCP framing. Empty if it is none of these.
std::optional<std::vector<TslDisplay>> decode_tsl(std::span<const std::byte> datagram);

}  // namespace vantage
