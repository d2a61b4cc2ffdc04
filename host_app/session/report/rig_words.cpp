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

bool delivers(const RigStatus& rig, const std::vector<RigStatus>& rigs) {
    return gives_pictures(rig, rigs) && rig.health.published_hz > 0;
}

bool waits_for_a_host(const RigStatus& rig) {
    return rig.connected && rig.sync.ready && rig.sync.role != RigSync::Role::free &&
           rig.sync.first_pulse == 0;
}

std::string silence_of(const RigStatus& rig) {
    if (!trouble_of(rig).empty() || rig.health.published_hz > 0) return {};
    if (waits_for_a_host(rig))
        return "it is connected and sends nothing: it is armed and starts when a host runs the "
               "stage (vantage live)";
    if (rig.health.captured_hz > 0)
        return "it is connected and captures, but sends nothing: a step after its cameras is "
               "stuck; see its log at the rig (journalctl -u vantage-rig)";
    return "it is connected and sends nothing: its cameras deliver no frames; see its log at the "
           "rig (journalctl -u vantage-rig), and run vantage-rig probe there";
}

}  // namespace vantage
