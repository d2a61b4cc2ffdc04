#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "common/base/error.h"
#include "common/base/time/time_zone.h"
#include "common/base/time/timecode.h"
#include "host_app/replay/transport.h"

/// A time as somebody types it: of a take, of the past, of a rig's own recording.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace vantage;
    const std::string text(reinterpret_cast<const char*>(data), size);
    if (const auto label = TimeLabel::parse(text)) {
        if (label->hours < 0 || label->hours > 23 || label->minutes < 0 || label->minutes > 59 ||
            label->seconds < 0 || label->seconds > 59 || label->frame.value_or(0) < 0)
            std::abort();
        if (!label->matches(*label)) std::abort();
    }
    constexpr double rates_hz[] = {25, 29.97, 59.94, 120};
    // A minute around the change from summer time in Europe.
    constexpr double unix_s = 1'792'890'000;
    static const bool is_zone_set = (use_time_zone("Europe/Berlin"), true);
    if (!is_zone_set) return 0;
    for (const double rate_hz : rates_hz) {
        const auto oldest = static_cast<std::uint64_t>(unix_s * rate_hz);
        const PastFrameSets::Span past{.oldest = oldest,
                                       .newest = oldest + static_cast<std::uint64_t>(60 * rate_hz),
                                       .sets = 1,
                                       .bytes = 1};
        try {
            const std::uint64_t pulse = pulse_in_past(text, past, rate_hz, 37);
            if (pulse < past.oldest || pulse > past.newest) std::abort();
        } catch (const Error&) {
        }
    }
    return 0;
}
