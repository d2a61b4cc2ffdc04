#include "host_app/ltc/smpte_code.h"

#include <fmt/format.h>

namespace vantage {

std::optional<SmpteCode> SmpteCode::parse(std::string_view text) {
    constexpr std::size_t length = 11;
    if (text.size() != length || text[2] != ':' || text[5] != ':' ||
        (text[8] != ':' && text[8] != ';'))
        return std::nullopt;
    const auto two = [&](std::size_t at) {
        const int tens = text[at] - '0', ones = text[at + 1] - '0';
        return tens < 0 || tens > 9 || ones < 0 || ones > 9 ? -1 : 10 * tens + ones;
    };
    const SmpteCode code{two(0), two(3), two(6), two(9), text[8] == ';'};
    if (code.hours < 0 || code.hours > 23 || code.minutes < 0 || code.minutes > 59 ||
        code.seconds < 0 || code.seconds > 59 || code.frame < 0)
        return std::nullopt;
    return code;
}

std::string SmpteCode::text() const {
    return fmt::format("{:02}:{:02}:{:02}{}{:02}", hours, minutes, seconds,
                       is_drop_frame ? ';' : ':', frame);
}

/// Numbers that drop-frame code skips per minute: 2 of 30, 4 of 60.
static std::int64_t dropped_of(const SmpteCount& count) {
    return count.is_drop_frame ? count.numbers_a_second / 15 : 0;
}

std::int64_t SmpteCount::frames() const {
    constexpr std::int64_t day_s = 86'400, minutes = 1440, tenth_minutes = 144;
    return day_s * numbers_a_second - dropped_of(*this) * (minutes - tenth_minutes);
}

std::optional<std::int64_t> SmpteCount::frame_of(const SmpteCode& code) const {
    const std::int64_t dropped = dropped_of(*this);
    if (code.is_drop_frame != is_drop_frame || code.frame >= numbers_a_second ||
        (code.seconds == 0 && code.minutes % 10 != 0 && code.frame < dropped))
        return std::nullopt;
    const std::int64_t minutes = 60 * code.hours + code.minutes;
    return (60 * minutes + code.seconds) * numbers_a_second + code.frame -
           dropped * (minutes - minutes / 10);
}

SmpteCode SmpteCount::code_of(std::int64_t frame) const {
    frame = (frame % frames() + frames()) % frames();
    if (const std::int64_t dropped = dropped_of(*this); dropped > 0) {
        const std::int64_t minute = 60 * numbers_a_second - dropped;
        const std::int64_t ten_minutes = 10 * minute + dropped;
        const std::int64_t tens = frame / ten_minutes, rest = frame % ten_minutes;
        frame += dropped * (9 * tens + (rest < dropped ? 0 : (rest - dropped) / minute));
    }
    const std::int64_t second = frame / numbers_a_second;
    return {static_cast<int>(second / 3600), static_cast<int>(second / 60 % 60),
            static_cast<int>(second % 60), static_cast<int>(frame % numbers_a_second),
            is_drop_frame};
}

std::int64_t SmpteCount::between(std::int64_t a, std::int64_t b) const {
    const std::int64_t later = ((a - b) % frames() + frames()) % frames();
    return later > frames() / 2 ? later - frames() : later;
}

}  // namespace vantage
