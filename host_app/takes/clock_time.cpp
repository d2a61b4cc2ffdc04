#include "host_app/takes/clock_time.h"

#include <cstdio>

#include "common/base/error.h"
#include "common/base/time/timecode.h"

namespace vantage {
namespace {

/// The parsed fields of a time; missing ones are empty.
struct Words {
    std::tm local{};
    bool has_date = false;
    std::optional<int> frame;
};

Words read(const std::string& text) {
    Words words;
    const std::size_t t = text.find('T');
    words.has_date = t != std::string::npos;
    std::tm& local = words.local;
    int used = 0, frame = 0, more = 0;
    bool fits = true;
    if (words.has_date) {
        fits = std::sscanf(text.c_str(), "%4d-%2d-%2d%n", &local.tm_year, &local.tm_mon,
                           &local.tm_mday, &used) == 3 &&
               static_cast<std::size_t>(used) == t;
        local.tm_year -= 1900;
        local.tm_mon -= 1;
    }
    const std::string clock = words.has_date ? text.substr(t + 1) : text;
    fits = fits && std::sscanf(clock.c_str(), "%2d:%2d:%2d%n", &local.tm_hour, &local.tm_min,
                               &local.tm_sec, &used) == 3;
    if (fits && static_cast<std::size_t>(used) < clock.size()) {
        fits = (clock[static_cast<std::size_t>(used)] == ':' ||
                clock[static_cast<std::size_t>(used)] == ';') &&
               std::sscanf(clock.c_str() + used + 1, "%2d%n", &frame, &more) == 1 &&
               static_cast<std::size_t>(used + 1 + more) == clock.size();
        words.frame = frame;
    }
    const std::tm told = local;
    local.tm_isdst = -1;
    std::tm whole = local;
    if (!words.has_date) whole.tm_year = 100, whole.tm_mday = 1;
    // mktime would normalise an hour 25 or a 31st of April.
    fits = fits && std::mktime(&whole) != -1 &&
           (!words.has_date || (whole.tm_mday == told.tm_mday && whole.tm_mon == told.tm_mon)) &&
           told.tm_hour >= 0 && told.tm_hour < 24 && told.tm_min >= 0 && told.tm_min < 60 &&
           told.tm_sec >= 0 && told.tm_sec < 60;
    if (!fits)
        fail("'{}' is not a time such as 20:15:00, 20:15:00:12 or 2026-11-22T20:15:00", text);
    return words;
}

/// The time of day on the day of `near` plus `days`.
std::time_t on_day_of(std::time_t near, const Words& words, int days) {
    std::tm day{};
    localtime_r(&near, &day);
    day.tm_hour = words.local.tm_hour;
    day.tm_min = words.local.tm_min;
    day.tm_sec = words.local.tm_sec;
    day.tm_mday += days;
    day.tm_isdst = -1;
    return std::mktime(&day);
}

}  // namespace

ClockSpan clock_span(const std::string& from, const std::string& to, std::time_t now) {
    const Words first = read(from), last = read(to);
    ClockSpan span{{from, 0, first.frame}, {to, 0, last.frame}};
    std::tm told = first.local;
    span.from.utc_s = first.has_date ? std::mktime(&told) : on_day_of(now, first, 0);
    if (!first.has_date && span.from.utc_s > now) span.from.utc_s = on_day_of(now, first, -1);
    const auto is_after = [&](std::time_t utc_s) {
        return std::pair(utc_s, span.to.frame.value_or(0)) >
               std::pair(span.from.utc_s, span.from.frame.value_or(0));
    };
    told = last.local;
    span.to.utc_s = last.has_date ? std::mktime(&told) : on_day_of(span.from.utc_s, last, 0);
    if (!last.has_date && !is_after(span.to.utc_s))
        span.to.utc_s = on_day_of(span.from.utc_s, last, 1);
    if (!is_after(span.to.utc_s)) fail("--from {} is not before --to {}", from, to);
    return span;
}

std::uint64_t pulse_of(const ClockTime& time, const PulseGrid& pulses, int tai_offset_s) {
    const TaiTime at{std::chrono::seconds(static_cast<std::int64_t>(time.utc_s) + tai_offset_s)};
    const std::uint64_t before = pulses.index_at_or_before(at);
    const std::uint64_t first = pulses.time_of(before) == at ? before : before + 1;
    if (!time.frame) return first;
    // Drop-frame code differs from the clock by up to some frames.
    const TimecodeClock clock(pulses.rate_hz());
    const std::string tail = fmt::format("{:02}", *time.frame);
    std::tm local{};
    localtime_r(&time.utc_s, &local);
    const std::string head =
        fmt::format("{:02}:{:02}:{:02}", local.tm_hour, local.tm_min, local.tm_sec);
    const auto second = static_cast<std::uint64_t>(pulses.rate_hz()) + 1;
    for (std::uint64_t pulse = first - second; pulse <= first + 2 * second; ++pulse) {
        const std::string code = clock.of_pulse(pulse, tai_offset_s);
        if (code.starts_with(head) && code.ends_with(tail)) return pulse;
    }
    fail("{} does not exist in time code at {:g} pulses per second", time.text, pulses.rate_hz());
}

}  // namespace vantage
