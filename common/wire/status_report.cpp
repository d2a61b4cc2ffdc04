#include "common/wire/status_report.h"

#include <fmt/format.h>

namespace vantage {
namespace {

const char* name_of(RigSync::Role role) {
    switch (role) {
        case RigSync::Role::lead:
            return "lead";
        case RigSync::Role::follow:
            return "follow";
        case RigSync::Role::free:
            break;
    }
    return "free";
}

}  // namespace

nlohmann::ordered_json to_json(const Percentiles& p) {
    return {{"count", p.count}, {"p50", p.p50}, {"p95", p.p95}, {"p99", p.p99}, {"max", p.max}};
}

nlohmann::ordered_json to_json(const RigCounters& counters) {
    return {{"captured", counters.captured},
            {"missed", counters.missed},
            {"late", counters.late},
            {"published", counters.published},
            {"send_dropped", counters.send_dropped}};
}

nlohmann::ordered_json to_json(const RigSync& sync) {
    return {{"role", name_of(sync.role)},
            {"ready", sync.ready},
            {"first_pulse", sync.first_pulse},
            {"pulses", sync.pulses},
            {"skipped", sync.skipped},
            {"unsynchronized", sync.unsynchronized},
            {"lateness_us",
             {{"p50", sync.lateness_p50_us},
              {"p99", sync.lateness_p99_us},
              {"max", sync.lateness_max_us}}},
            {"clock_ppm", sync.clock_ppm},
            {"clock_steps", sync.clock_steps},
            {"clock_step_ms", sync.clock_step_ms},
            {"disciplined", sync.disciplined},
            {"ptp_state", sync.ptp_state},
            {"ptp_offset_ns", sync.ptp_offset_ns},
            {"ptp_path_delay_ns", sync.ptp_path_delay_ns},
            {"tai_offset_s", sync.tai_offset_s},
            {"rate_hz", sync.rate_hz}};
}

nlohmann::ordered_json to_json(const RigHealth& health) {
    nlohmann::ordered_json json{{"captured_hz", health.captured_hz},
                                {"published_hz", health.published_hz},
                                {"temperature_c", nullptr},
                                {"under_voltage", health.under_voltage},
                                {"refused_connections", health.refused_connections},
                                {"calibration", nullptr}};
    if (!health.program_version.empty()) json["version"] = health.program_version;
    if (!health.starting.empty()) json["starting"] = health.starting;
    if (health.temperature_c) json["temperature_c"] = *health.temperature_c;
    if (!health.calibration_date.empty())
        json["calibration"] = {{"id", health.calibration_id},
                               {"date", health.calibration_date},
                               {"row_rms_px", health.calibration_row_rms_px}};
    return json;
}

std::string pulse_text(const RigSync& sync) {
    if (sync.role == RigSync::Role::free) return "";
    if (sync.first_pulse == 0) return "armed, no pulse announced yet";
    return fmt::format(
        "{} pulses, {} skipped, late us p50 {:.1f}, p99 {:.1f}, max {:.1f}; {} frames without a "
        "pulse",
        sync.pulses, sync.skipped, sync.lateness_p50_us, sync.lateness_p99_us, sync.lateness_max_us,
        sync.unsynchronized);
}

std::string health_text(const RigHealth& health) {
    std::string text = fmt::format("{:.1f} frames/s captured, {:.1f} published", health.captured_hz,
                                   health.published_hz);
    if (!health.starting.empty()) text += "; starting: " + health.starting;
    if (health.temperature_c) text += fmt::format("; {:.0f} C", *health.temperature_c);
    if (health.under_voltage) text += "; UNDER-VOLTAGE: use a stronger supply or a shorter cable";
    if (health.refused_connections > 0)
        text += fmt::format("; refused {} connections that are not from a host",
                            health.refused_connections);
    if (!health.keeps.empty()) text += "; " + health.keeps;
    if (!health.program_version.empty()) text += "; version " + health.program_version;
    if (health.calibration_date.empty()) return text + "; no calibration file";
    return text + fmt::format("; calibrated {}, rows to {:.2f} px", health.calibration_date,
                              health.calibration_row_rms_px);
}

}  // namespace vantage
