#include "host_app/takes/clock_time.h"

#include <algorithm>
#include <cstdio>
#include <string_view>
#include <vector>

#include "common/base/error.h"
#include "common/base/log.h"
#include "common/base/time/timecode.h"
#include "common/base/time/utc_offset.h"

namespace vantage {
namespace {

/// The parsed fields of a time; missing ones are empty.
struct Words {
    std::tm local{};
    bool has_date = false;
    std::optional<int> frame;
    std::optional<int> utc_offset_s;  ///< empty: local time
};

Words read(std::string text) {
    const std::string written = text;
    Words words;
    words.utc_offset_s = take_utc_offset(text);
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
        fail(
            "'{}' is not a time such as 20:15:00, 20:15:00:12 or 2026-11-22T20:15:00, each "
            "optionally with Z or an offset such as +01:00",
            written);
    return words;
}

/// The moments at which local clocks show this time: two in the hour that occurs twice, none in the
/// hour that is skipped.
std::vector<std::time_t> moments_of(const std::tm& shown) {
    std::vector<std::time_t> moments;
    for (const int is_summer : {1, 0}) {
        std::tm wanted = shown;
        wanted.tm_isdst = is_summer;
        const std::time_t moment = std::mktime(&wanted);
        std::tm back{};
        localtime_r(&moment, &back);
        if (back.tm_hour == shown.tm_hour && back.tm_min == shown.tm_min &&
            back.tm_sec == shown.tm_sec &&
            std::find(moments.begin(), moments.end(), moment) == moments.end())
            moments.push_back(moment);
    }
    std::sort(moments.begin(), moments.end());
    return moments;
}

/// The moments on the date of the words, or without a date on the day of `near` plus `days`.
std::vector<std::time_t> moments_of(const Words& words, std::time_t near, int days) {
    std::tm shown = words.local;
    const std::time_t offset_s = words.utc_offset_s.value_or(0);
    if (!words.has_date) {
        std::tm day{};
        const std::time_t there = near + offset_s;
        if (words.utc_offset_s)
            gmtime_r(&there, &day);
        else
            localtime_r(&near, &day);
        shown.tm_year = day.tm_year;
        shown.tm_mon = day.tm_mon;
        shown.tm_mday = day.tm_mday + days;
    }
    if (words.utc_offset_s) return {timegm(&shown) - offset_s};
    return moments_of(shown);
}

std::string utc_text(std::time_t moment) {
    std::tm utc{};
    gmtime_r(&moment, &utc);
    return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}Z", utc.tm_year + 1900, utc.tm_mon + 1,
                       utc.tm_mday, utc.tm_hour, utc.tm_min, utc.tm_sec);
}

/// Returns the first or last of these moments that fits, or the first one if none does.
template <class Fits>
std::time_t choose(const std::string& text, const Words& words,
                   const std::vector<std::vector<std::time_t>>& days, bool takes_last, Fits fits) {
    std::optional<std::time_t> chosen, any;
    const std::vector<std::time_t>* of_day = nullptr;
    for (const std::vector<std::time_t>& day : days)
        for (const std::time_t moment : day) {
            if (!any) any = moment;
            if (!fits(moment) || (chosen && !takes_last)) continue;
            chosen = moment;
            of_day = &day;
        }
    if (!any)
        fail("{} is in the hour that is skipped when clocks are set forward: there is no such time",
             text);
    if (of_day && of_day->size() > 1 && !words.utc_offset_s) {
        const std::time_t other = of_day->front() == *chosen ? of_day->back() : of_day->front();
        constexpr std::size_t date = std::string_view("2026-10-25T").size();
        log_info("{} occurs twice, since clocks were set back: {} is taken; say {} for the other",
                 text, utc_text(*chosen), utc_text(other).substr(date));
    }
    return chosen.value_or(*any);
}

}  // namespace

ClockSpan clock_span(const std::string& from, const std::string& to, std::time_t now) {
    const Words first = read(from), last = read(to);
    ClockSpan span{{from, 0, first.frame}, {to, 0, last.frame}};
    const auto days_of = [](const Words& words, std::time_t near, int from_day, int to_day) {
        std::vector<std::vector<std::time_t>> days;
        for (int day = from_day; day <= (words.has_date ? from_day : to_day); ++day)
            days.push_back(moments_of(words, near, day));
        return days;
    };
    span.from.utc_s = choose(from, first, days_of(first, now, -1, 0), true,
                             [now](std::time_t moment) { return moment <= now; });
    const auto is_after = [&](std::time_t utc_s) {
        return std::pair(utc_s, span.to.frame.value_or(0)) >
               std::pair(span.from.utc_s, span.from.frame.value_or(0));
    };
    span.to.utc_s = choose(to, last, days_of(last, span.from.utc_s, 0, 1), false, is_after);
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
