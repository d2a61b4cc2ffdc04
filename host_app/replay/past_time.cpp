#include "host_app/replay/past_time.h"

#include <charconv>
#include <cmath>
#include <optional>

#include "common/base/error.h"
#include "common/base/time/timecode.h"

namespace vantage {
namespace {

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
        fail("{} s is outside the past, which has {:.1f} s; give a time within it", words,
             static_cast<double>(past.newest - past.oldest) / pulse_rate_hz);
    return static_cast<std::uint64_t>(std::llround(there));
}

}  // namespace

std::uint64_t pulse_in_past(const std::string& words, const PastFrameSets::Span& past,
                            double pulse_rate_hz, int tai_offset_s) {
    if (words.find_first_of(":;") == std::string::npos)
        return pulse_of_seconds(words, past, pulse_rate_hz);
    const TimecodeClock clock(pulse_rate_hz);
    const std::optional<TimeLabel> label = TimeLabel::parse(words);
    if (!label)
        fail("'{}' is neither a time code, such as 20:15:07:12, nor seconds, such as 12.5 or -3",
             words);
    if (const std::string why = clock.why_never(*label); !why.empty()) fail("{} {}", words, why);
    if (const auto pulse = clock.find(*label, past.oldest, past.newest, tai_offset_s))
        return *pulse;
    fail("{} is outside the past, which goes from {} to {}; give a time within it", words,
         clock.of_pulse(past.oldest, tai_offset_s), clock.of_pulse(past.newest, tai_offset_s));
}

}  // namespace vantage
