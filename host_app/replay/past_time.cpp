#include "host_app/replay/past_time.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include <time.h>

#include "common/base/error.h"
#include "common/base/time/timecode.h"
#include "common/base/time/utc_offset.h"

namespace vantage {
namespace {

constexpr std::size_t letters_to_the_second = 8, letters_to_the_frame = 11;
constexpr std::int64_t s_per_day = 86'400;

std::string with_colons(std::string code) {
    std::replace(code.begin(), code.end(), ';', ':');
    return code;
}

std::uint64_t pulse_of_seconds(const std::string& words, const PastFrameSets::Span& past,
                               double pulse_rate_hz) {
    double seconds = 0;
    const char* last = words.data() + words.size();
    const auto [end, error] = std::from_chars(words.data(), last, seconds);
    if (error != std::errc() || end != last || !std::isfinite(seconds))
        fail("'{}' is neither a time code, such as 20:15:07:12, nor seconds, such as 12.5 or -3",
             words);
    const double from = static_cast<double>(std::signbit(seconds) ? past.newest : past.oldest);
    const double there = from + seconds * pulse_rate_hz;
    if (there < static_cast<double>(past.oldest) || there > static_cast<double>(past.newest))
        fail("{} s is not in the past that there is, which has {:.1f} s", words,
             static_cast<double>(past.newest - past.oldest) / pulse_rate_hz);
    return static_cast<std::uint64_t>(std::llround(there));
}

}  // namespace

std::uint64_t pulse_in_past(const std::string& words, const PastFrameSets::Span& past,
                            double pulse_rate_hz, int tai_offset_s) {
    std::string wanted = with_colons(words);
    const std::optional<int> utc_offset_s = take_utc_offset(wanted);
    if (!utc_offset_s && wanted.find(':') == std::string::npos)
        return pulse_of_seconds(words, past, pulse_rate_hz);
    const TimecodeClock clock(pulse_rate_hz);
    const PulseGrid grid(pulse_rate_hz);
    const auto code_of = [&](std::uint64_t pulse) {
        std::string code = with_colons(clock.of_pulse(pulse, tai_offset_s));
        if (!utc_offset_s) return code;
        // The numbers of frames are the same in every zone of whole minutes.
        const time_t utc_s = to_ns(grid.time_of(pulse)) / nanoseconds_per_second - tai_offset_s;
        tm local{};
        localtime_r(&utc_s, &local);
        const std::int64_t local_s = 3600 * std::stoi(code.substr(0, 2)) +
                                     60 * std::stoi(code.substr(3, 2)) +
                                     std::stoi(code.substr(6, 2));
        const std::int64_t of_day_s =
            (local_s + *utc_offset_s - local.tm_gmtoff + 2 * s_per_day) % s_per_day;
        return fmt::format("{:02}:{:02}:{:02}", of_day_s / 3600, of_day_s / 60 % 60,
                           of_day_s % 60) +
               code.substr(letters_to_the_second);
    };
    if (wanted.size() == letters_to_the_second || wanted.size() == letters_to_the_frame) {
        // Seconds are passed in half ones, so that none is missed; within one every frame is looked
        // at.
        const auto second = static_cast<std::uint64_t>(std::ceil(pulse_rate_hz));
        const std::string_view to_the_second =
            std::string_view(wanted).substr(0, letters_to_the_second);
        // From the newest on: in the hour that comes twice it is the later one.
        const std::uint64_t step = std::max<std::uint64_t>(1, second / 2);
        for (std::uint64_t at = past.newest;;
             at = at > past.oldest + step ? at - step : past.oldest) {
            if (code_of(at).starts_with(to_the_second)) {
                const std::uint64_t first = std::max(past.oldest, at - std::min(at, second));
                for (std::uint64_t pulse = first; pulse <= std::min(past.newest, at + second);
                     ++pulse)
                    if (code_of(pulse).starts_with(wanted)) return pulse;
            }
            if (at == past.oldest) break;
        }
    }
    fail("{} is not in the past that there is, from {} to {}", words,
         clock.of_pulse(past.oldest, tai_offset_s), clock.of_pulse(past.newest, tai_offset_s));
}

}  // namespace vantage
