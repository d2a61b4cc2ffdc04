#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace vantage {

/// Takes the bytes of a connection apart into messages of TSL UMD 5.0, as it wraps them for TCP:
/// DLE STX (0xFE 0x02) begins one, a DLE within it is sent twice, and its first two bytes say where
/// it ends. Some senders leave the wrapping out, or send version 3.1: both are taken.
class TslStream {
  public:
    /// The messages that these bytes complete, for decode_tsl().
    std::vector<std::string> take(std::string_view bytes);
    /// Part of a message waits for the rest of it.
    bool has_rest() const {
        return is_after_dle_ || place_ == Place::inside || place_ == Place::bare;
    }
    /// Runs of bytes so far that were no message: before one, broken off, or too long.
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

}  // namespace vantage
