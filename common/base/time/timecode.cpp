#include "common/base/time/timecode.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <time.h>

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

}  // namespace vantage
