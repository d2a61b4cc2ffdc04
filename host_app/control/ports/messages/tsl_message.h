#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace vantage {

/// Splits the bytes of a TCP connection into messages of TSL UMD 5.0. DLE STX (0xFE 0x02) begins a
/// message, a DLE within it is doubled, and its first two bytes contain its length. Messages
/// without this framing and messages of version 3.1, which some senders use, are accepted too.
class TslStream {
  public:
    /// Returns the messages that these bytes complete, for decode_tsl().
    std::vector<std::string> take(std::string_view bytes);
    /// True while a part of a message waits for the rest.
    bool has_rest() const {
        return is_after_dle_ || place_ == Place::inside || place_ == Place::bare;
    }
    /// Number of byte runs that were not part of a valid message, were broken off, or were too
    /// long.
    std::uint64_t strays() const { return strays_; }

  private:
    enum class Place { outside, inside, bare, stray };

    void append(char byte, std::vector<std::string>& whole);
    void append_bare(char byte, std::vector<std::string>& whole);
    void stray();

    Place place_ = Place::outside;
    bool is_after_dle_ = false;
    std::string message_;
    std::uint64_t strays_ = 0;
};

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
