#include "host_app/session/report/rig_words.h"

#include <algorithm>
#include <ctime>

#include <fmt/format.h>

namespace vantage {

std::optional<int> days_since(const std::string& date, std::chrono::system_clock::time_point now) {
    std::tm then{};
    if (std::sscanf(date.c_str(), "%4d-%2d-%2d", &then.tm_year, &then.tm_mon, &then.tm_mday) != 3)
        return std::nullopt;
    then.tm_year -= 1900;
    then.tm_mon -= 1;
    const auto age = now - std::chrono::system_clock::from_time_t(timegm(&then));
    return std::max(0,
                    static_cast<int>(std::chrono::duration_cast<std::chrono::days>(age).count()));
}

std::string short_clock_words(const RigStatus& rig) {
    if (!rig.connected) return "";
    if (rig.same_clock) return "this computer";
    if (!rig.sync.disciplined) return "no PTP";
    return fmt::format("PTP {:+.0f} ns", rig.sync.ptp_offset_ns);
}

std::string calibration_words(const RigHealth& health, std::chrono::system_clock::time_point now) {
    const std::optional<int> days = days_since(health.calibration_date, now);
    return days ? fmt::format("{} d, {:.2f} px", *days, health.calibration_row_rms_px) : "";
}

}  // namespace vantage
