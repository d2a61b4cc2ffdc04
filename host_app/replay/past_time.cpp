#include "host_app/replay/past_time.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "common/base/error.h"
#include "common/base/time/timecode.h"

namespace vantage {
namespace {

constexpr std::size_t letters_to_the_second = 8, letters_to_the_frame = 11;

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
        fail("{} s is outside the past, which has {:.1f} s; give a time within it", words,
             static_cast<double>(past.newest - past.oldest) / pulse_rate_hz);
    return static_cast<std::uint64_t>(std::llround(there));
}

}  // namespace

std::uint64_t pulse_in_past(const std::string& words, const PastFrameSets::Span& past,
                            double pulse_rate_hz, int tai_offset_s) {
    const std::string wanted = with_colons(words);
    if (wanted.find(':') == std::string::npos) return pulse_of_seconds(words, past, pulse_rate_hz);
    const TimecodeClock clock(pulse_rate_hz);
    const auto code_of = [&](std::uint64_t pulse) {
        return with_colons(clock.of_pulse(pulse, tai_offset_s));
    };
    if (wanted.size() == letters_to_the_second || wanted.size() == letters_to_the_frame) {
        // The search goes by half seconds, so that no second is missed, and then by frames.
        const auto second = static_cast<std::uint64_t>(std::ceil(pulse_rate_hz));
        const std::string_view to_the_second =
            std::string_view(wanted).substr(0, letters_to_the_second);
        for (std::uint64_t at = past.oldest;; at += std::max<std::uint64_t>(1, second / 2)) {
            at = std::min(at, past.newest);
            if (code_of(at).starts_with(to_the_second)) {
                const std::uint64_t first = std::max(past.oldest, at - std::min(at, second));
                for (std::uint64_t pulse = first; pulse <= std::min(past.newest, at + second);
                     ++pulse)
                    if (code_of(pulse).starts_with(wanted)) return pulse;
            }
            if (at == past.newest) break;
        }
    }
    fail("{} is outside the past, which goes from {} to {}; give a time within it", words,
         clock.of_pulse(past.oldest, tai_offset_s), clock.of_pulse(past.newest, tai_offset_s));
}

}  // namespace vantage
