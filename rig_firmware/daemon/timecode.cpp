#include "rig_firmware/daemon/timecode.h"

#include <cmath>

#include <fmt/format.h>

namespace vantage {

std::string time_of_day_code(TaiTime instant, double rate_hz) {
    constexpr std::int64_t ns_per_second = 1'000'000'000;
    const std::int64_t ns = to_ns(instant);
    const std::int64_t of_day_s = ns / ns_per_second % 86'400;
    constexpr double most_frames_a_second = 60;
    const double frames_a_number = std::ceil(rate_hz / most_frames_a_second);
    // A thousandth of a frame of tolerance: pulse times are rounded down to a nanosecond.
    const double frame = static_cast<double>(ns % ns_per_second) * 1e-9 * rate_hz + 1e-3;
    return fmt::format("{:02}:{:02}:{:02}:{:02}", of_day_s / 3600, of_day_s / 60 % 60,
                       of_day_s % 60, static_cast<int>(frame / frames_a_number));
}

}  // namespace vantage
