#include "host_app/ltc/smpte_code.h"

#include <fmt/format.h>

#include "common/base/time/timecode.h"

namespace vantage {

std::optional<SmpteCode> SmpteCode::parse(std::string_view text) {
    const std::optional<TimeLabel> label = TimeLabel::parse(text);
    if (!label || !label->frame || label->utc_offset_s || text[2] != ':' || text[5] != ':')
        return std::nullopt;
    return SmpteCode{label->hours, label->minutes, label->seconds, *label->frame, text[8] == ';'};
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
