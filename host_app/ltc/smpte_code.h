#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace vantage {

/// A time code of SMPTE ST 12-1, "hh:mm:ss:ff", drop-frame "hh:mm:ss;ff".
struct SmpteCode {
    int hours = 0, minutes = 0, seconds = 0, frame = 0;
    bool is_drop_frame = false;

    /// Nothing: it is none.
    static std::optional<SmpteCode> parse(std::string_view text);
    std::string text() const;
    bool operator==(const SmpteCode&) const = default;
};

/// What is counted: 24, 25, 30 numbers a second, or 50 or 60 where fields or pictures are; of 30
/// and 60 also as drop-frame code, which leaves out numbers of every minute but each tenth.
struct SmpteCount {
    int numbers_a_second = 25;
    bool is_drop_frame = false;

    /// In a day.
    std::int64_t frames() const;
    /// Since midnight. Nothing: there is no such code.
    std::optional<std::int64_t> frame_of(const SmpteCode& code) const;
    /// Of any frame: a day has no end.
    SmpteCode code_of(std::int64_t frame) const;
    /// By how many frames `a` is later than `b`, the shorter way around the day.
    std::int64_t between(std::int64_t a, std::int64_t b) const;
};

}  // namespace vantage
