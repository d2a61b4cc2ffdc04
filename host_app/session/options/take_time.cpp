#include "host_app/session/options/take_time.h"

#include <cmath>
#include <optional>

#include "common/base/error.h"
#include "common/base/time/pulse_grid.h"
#include "common/base/time/timecode.h"

namespace vantage {

std::uint64_t pulse_of(const TakeReader& take, const std::string& text, std::uint64_t first,
                       std::uint64_t last) {
    const PulseGrid pulses(take.facts().pulse_rate_hz);
    if (text.find_first_of(":;") == std::string::npos) {
        std::size_t used = 0;
        double seconds = -1;
        try {
            seconds = std::stod(text, &used);
        } catch (const std::exception&) {
        }
        constexpr double longest_s = 1e7;
        if (used != text.size() || !(seconds >= 0 && seconds <= longest_s))
            fail(
                "'{}' is neither seconds after the beginning, such as 12.5, nor a time code, such "
                "as {}",
                text, take.facts().timecode);
        return first + static_cast<std::uint64_t>(std::llround(seconds * pulses.rate_hz()));
    }
    const TimecodeClock clock(take.facts().pulse_rate_hz);
    const std::optional<TimeLabel> label = TimeLabel::parse(text);
    if (!label)
        fail(
            "'{}' is no time code, such as {} (';' or ':' before the frame, which may be left out)",
            text, take.facts().timecode);
    if (const std::string why = clock.why_never(*label); !why.empty()) fail("{} {}", text, why);
    constexpr std::uint64_t most_pulses = 1'000'000'000;
    if (last - first > most_pulses)
        fail("{} spans {} pulses, too many to look for {} in: say seconds after its beginning",
             take.path().string(), last - first, text);
    const int tai_offset_s = take.facts().tai_offset_s;
    if (const auto pulse = clock.find(*label, first, last + 1, tai_offset_s)) return *pulse;
    fail("{} is not in {}, which goes from {} to {}", text, take.path().string(),
         clock.of_pulse(first, tai_offset_s), clock.of_pulse(last, tai_offset_s));
}

}  // namespace vantage
