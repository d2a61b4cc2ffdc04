#include "common/base/time/timecode.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <time.h>

#include "common/base/log.h"
#include "common/base/time/utc_offset.h"

namespace vantage {
namespace {

constexpr std::int64_t ns_per_second = 1'000'000'000;
/// Above 60 fps, several frames share a number, as SMPTE ST 12-1 has no larger numbers.
constexpr double max_numbers_per_second = 60;

std::int64_t local_seconds_of_day(std::int64_t utc_s) {
    const time_t seconds = utc_s;
    tm local{};
    localtime_r(&seconds, &local);
    // A leap second has the number 60; it shares the label of second 59.
    return local.tm_hour * 3600 + local.tm_min * 60 + std::min(local.tm_sec, 59);
}

std::string written(std::int64_t seconds_of_day, std::int64_t frame, char mark) {
    return fmt::format("{:02}:{:02}:{:02}{}{:02}", seconds_of_day / 3600, seconds_of_day / 60 % 60,
                       seconds_of_day % 60, mark, frame);
}

/// The label of the n-th number after midnight in drop-frame code, which skips the first numbers of
/// every minute except each tenth.
std::string drop_frame_code(std::int64_t n, int numbers_per_second) {
    const std::int64_t dropped = numbers_per_second / 15;  // 2 of 30, 4 of 60
    const std::int64_t a_minute = 60 * numbers_per_second - dropped;
    const std::int64_t ten_minutes = 10 * a_minute + dropped;
    // A day has a few more frames than numbers: the last frames share the last number.
    n = std::min(n, 144 * ten_minutes - 1);
    const std::int64_t in_ten = n % ten_minutes;
    const std::int64_t minutes_short = in_ten < dropped ? 0 : (in_ten - dropped) / a_minute;
    const std::int64_t number = n + dropped * (9 * (n / ten_minutes) + minutes_short);
    return written(number / numbers_per_second, number % numbers_per_second, ';');
}

}  // namespace

std::optional<TimeLabel> TimeLabel::parse(std::string_view text) {
    std::string without_offset(text);
    const std::optional<int> utc_offset_s = take_utc_offset(without_offset);
    text = without_offset;
    constexpr std::size_t to_the_second = 8, to_the_frame = 11;
    constexpr int hours_a_day = 24, of_sixty = 60;
    if (text.size() != to_the_second && text.size() != to_the_frame) return std::nullopt;
    std::array<int, 4> numbers{};
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (i % 3 == 2 ? c != ':' && c != ';' : c < '0' || c > '9') return std::nullopt;
        if (i % 3 != 2) numbers[i / 3] = 10 * numbers[i / 3] + (c - '0');
    }
    if (numbers[0] >= hours_a_day || numbers[1] >= of_sixty || numbers[2] >= of_sixty)
        return std::nullopt;
    TimeLabel label{numbers[0], numbers[1], numbers[2]};
    label.utc_offset_s = utc_offset_s;
    if (text.size() == to_the_frame) label.frame = numbers[3];
    return label;
}

bool TimeLabel::matches(const TimeLabel& whole) const {
    return hours == whole.hours && minutes == whole.minutes && seconds == whole.seconds &&
           (!frame || frame == whole.frame);
}

TimecodeClock::TimecodeClock(double rate_hz)
    : grid_(rate_hz),
      frames_per_number_(static_cast<int>(std::ceil(grid_.rate_hz() / max_numbers_per_second))),
      numbers_per_second_(static_cast<int>(std::ceil(grid_.rate_hz() / frames_per_number_))) {
    const double short_of_nominal = numbers_per_second_ * frames_per_number_ / grid_.rate_hz();
    is_drop_frame_ = numbers_per_second_ % 30 == 0 && std::abs(short_of_nominal - 1.001) < 1e-9;
}

std::string TimecodeClock::of_pulse(std::uint64_t frame, int tai_offset_s) const {
    const std::int64_t second = to_ns(grid_.time_of(frame)) / ns_per_second;
    const std::int64_t of_day_s = local_seconds_of_day(second - tai_offset_s);
    const auto frames_since = [&](std::int64_t from_s) {
        const TaiTime from = tai_from_ns(from_s * ns_per_second);
        const std::uint64_t before = grid_.index_at_or_before(from);
        const std::uint64_t first = grid_.time_of(before) == from ? before : before + 1;
        return static_cast<std::int64_t>(frame - first) / frames_per_number_;
    };
    return is_drop_frame_ ? drop_frame_code(frames_since(second - of_day_s), numbers_per_second_)
                          : written(of_day_s, frames_since(second), ':');
}

std::optional<std::uint64_t> TimecodeClock::find(const TimeLabel& label, std::uint64_t first,
                                                 std::uint64_t last, int tai_offset_s) const {
    const std::optional<std::uint64_t> found = find_last(label, first, last, tai_offset_s);
    if (!found || label.utc_offset_s) return found;
    // Clocks are set back by an hour, or by half an hour on Lord Howe Island.
    constexpr double longest_s = 5400, shortest_s = 1500;
    const auto longest = static_cast<std::uint64_t>(longest_s * grid_.rate_hz());
    const auto shortest = static_cast<std::uint64_t>(shortest_s * grid_.rate_hz());
    if (*found < first + shortest) return found;
    const std::uint64_t from = std::max(first, *found - std::min(*found, longest));
    const auto other = find_last(label, from, *found - shortest, tai_offset_s);
    if (!other) return found;
    const auto utc_text = [&](std::uint64_t pulse) {
        const time_t utc_s = to_ns(grid_.time_of(pulse)) / ns_per_second - tai_offset_s;
        tm utc{};
        gmtime_r(&utc_s, &utc);
        return fmt::format("{:02}:{:02}:{:02}Z", utc.tm_hour, utc.tm_min, utc.tm_sec);
    };
    log_info(
        "{:02}:{:02}:{:02} occurs twice, since clocks were set back: {} is taken; say {} for the "
        "other",
        label.hours, label.minutes, label.seconds, utc_text(*found), utc_text(*other));
    return found;
}

TimeLabel TimecodeClock::label_of(std::uint64_t pulse, int tai_offset_s,
                                  std::optional<int> utc_offset_s) const {
    TimeLabel label = TimeLabel::parse(of_pulse(pulse, tai_offset_s)).value_or(TimeLabel{});
    if (!utc_offset_s) return label;
    // The numbers of frames are the same in every zone of whole minutes.
    constexpr std::int64_t day_s = 86'400, hour_s = 3600, minute_s = 60;
    const time_t utc_s = to_ns(grid_.time_of(pulse)) / ns_per_second - tai_offset_s;
    tm local{};
    localtime_r(&utc_s, &local);
    const std::int64_t of_day_s = (hour_s * label.hours + minute_s * label.minutes + label.seconds +
                                   *utc_offset_s - local.tm_gmtoff + 2 * day_s) %
                                  day_s;
    label.hours = static_cast<int>(of_day_s / hour_s);
    label.minutes = static_cast<int>(of_day_s / minute_s % minute_s);
    label.seconds = static_cast<int>(of_day_s % minute_s);
    return label;
}

std::optional<std::uint64_t> TimecodeClock::find_last(const TimeLabel& label, std::uint64_t first,
                                                      std::uint64_t last, int tai_offset_s) const {
    const auto label_at = [&](std::uint64_t pulse) {
        return label_of(pulse, tai_offset_s, label.utc_offset_s);
    };
    TimeLabel second_of_label = label;
    second_of_label.frame.reset();
    // Seconds are passed in half ones, so that none is missed; within one every pulse is looked at.
    const auto second = static_cast<std::uint64_t>(std::ceil(grid_.rate_hz()));
    const std::uint64_t step = std::max<std::uint64_t>(1, second / 2);
    for (std::uint64_t at = last;; at = at > first + step ? at - step : first) {
        if (second_of_label.matches(label_at(at))) {
            const std::uint64_t end = std::min(last, at + second);
            for (std::uint64_t pulse = std::max(first, at - std::min(at, second)); pulse <= end;
                 ++pulse)
                if (label.matches(label_at(pulse))) return pulse;
        }
        if (at == first) return std::nullopt;
    }
}

std::string TimecodeClock::why_never(const TimeLabel& label) const {
    if (!label.frame) return {};
    if (*label.frame >= numbers_per_second_)
        return fmt::format("does not exist at {:.5g} frames per second: its frames are 00 to {:02}",
                           grid_.rate_hz(), numbers_per_second_ - 1);
    const int dropped = is_drop_frame_ ? numbers_per_second_ / 15 : 0;
    if (label.seconds == 0 && label.minutes % 10 != 0 && *label.frame < dropped)
        return fmt::format(
            "does not exist at {:.5g} frames per second: drop-frame code begins this minute with "
            "{:02}:{:02}:00;{:02}",
            grid_.rate_hz(), label.hours, label.minutes, dropped);
    return {};
}

}  // namespace vantage
