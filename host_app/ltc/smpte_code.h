#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace vantage {

/// A time code of SMPTE ST 12-1: "hh:mm:ss:ff", or drop-frame "hh:mm:ss;ff".
struct SmpteCode {
    int hours = 0, minutes = 0, seconds = 0, frame = 0;
    bool is_drop_frame = false;

    /// Empty if the text is not a time code.
    static std::optional<SmpteCode> parse(std::string_view text);
    std::string text() const;
    bool operator==(const SmpteCode&) const = default;
};

/// Converts between time codes and frame counts at a rate: 24, 25 or 30 per second, or 50 or 60 for
/// fields or pictures; 30 and 60 also as drop-frame code, which skips numbers in every minute
/// except each tenth.
struct SmpteCount {
    int numbers_a_second = 25;
    bool is_drop_frame = false;

    /// The number of frames in a day.
    std::int64_t frames() const;
    /// The frame count since midnight; empty for a code that does not exist.
    std::optional<std::int64_t> frame_of(const SmpteCode& code) const;
    /// The code of any frame count, modulo a day.
    SmpteCode code_of(std::int64_t frame) const;
    /// By how many frames `a` is later than `b`, the shorter way around the day.
    std::int64_t between(std::int64_t a, std::int64_t b) const;
};

}  // namespace vantage
