#include "host_app/session/report/live_report.h"

#include <algorithm>
#include <ctime>

#include <fmt/format.h>

#include "common/base/counted.h"

namespace vantage {

// A disconnected rig has no worries: its last report may no longer hold.
std::vector<std::string> computer_worries_of(const RigStatus& status) {
    // A Raspberry Pi's processors slow down from here on.
    constexpr float hot_c = 80;
    std::vector<std::string> worries;
    if (!status.connected) return worries;
    if (!status.health.starting.empty()) worries.push_back(status.health.starting);
    if (status.health.temperature_c.value_or(0) >= hot_c)
        worries.push_back(fmt::format("{:.0f} C, it throttles from {:.0f} C on",
                                      *status.health.temperature_c, hot_c));
    if (status.health.under_voltage) worries.emplace_back("the supply voltage is too low");
    return worries;
}

std::vector<CounterGroup> counters_of(const RigAccount& rig) {
    const RigStatus& s = rig.status;
    const RigCounters& r = s.rig_counters;
    return {
        {"rig",
         "at the rig, since this host connected",
         {{"captured", "captured", r.captured},
          {"missed", "missed", r.missed},
          {"late", "late", r.late},
          {"published", "published", r.published}}},
        {"link",
         "on the way to this host",
         {{"offered", "offered", s.link.offered},
          {"send_dropped", "dropped at rig", s.link.send_dropped},
          {"skipped", "skipped", s.link.skipped, "thinned"},  // old name
          {"sent", "sent", s.link.sent},
          {"lost", "lost", s.lost}}},
        {"host",
         "at this host",
         {{"received", "received", s.received},
          {"undecodable", "damaged", s.undecodable},
          {"queue_dropped", "dropped at host", s.queue_dropped},
          {"late", "late", s.late},
          {"duplicate", "duplicate", s.duplicate},
          {"unsynchronized", "unsynchronised", s.unsynchronized},
          {"out_of_step", "out of step", s.out_of_step},
          {"in_frame_sets", "in frame sets", s.in_frame_sets, "in_sets"},
          {"fused", "fused", rig.fused},
          {"replaced", "replaced by newer", rig.replaced, "superseded"},  // old name
          {"dropped_at_start", "dropped at start", s.in_dropped_frame_sets, "in_dropped_sets"}}}};
}

std::string state_of(const RigStatus& status) {
    if (status.is_removed) return "removed";
    if (!status.refused.empty()) return "refused: " + status.refused;
    return status.connected ? "connected" : "disconnected";
}

std::string full_state_of(const RigStatus& status) {
    if (status.is_removed) return removed_rig;
    if (!status.refused.empty()) return state_of(status);
    const std::string trouble = trouble_of(status);
    return trouble.empty() ? state_of(status) : state_of(status) + ": " + trouble;
}

std::string outages_of(const RigStatus& status) {
    std::string text;
    if (status.outages > 0)
        text = fmt::format("was disconnected {}, {:.1f} s in all", counted_times(status.outages),
                           status.outage_s);
    if (status.restarts > 0)
        text += fmt::format("{}its daemon restarted {}", text.empty() ? "" : "; ",
                            counted_times(status.restarts));
    return text;
}

std::vector<std::string> worries_of(const RigStatus& status) {
    std::vector<std::string> worries = computer_worries_of(status);
    if (status.connected)
        if (std::string worry = rate_warning(status); !worry.empty())
            worries.push_back(std::move(worry));
    if (status.connected && !status.same_clock && !status.sync.disciplined)
        worries.emplace_back(clocks_not_disciplined);
    if (status.connected)
        if (std::string worry = tai_warning(status); !worry.empty())
            worries.push_back(std::move(worry));
    if (status.connected && !status.datagram_trouble.empty()) worries.push_back(road_worry(status));
    return worries;
}

std::string road_worry(const RigStatus& status) {
    return "its frames come over TCP because " + status.datagram_trouble;
}

std::vector<std::string> failures_of(const LiveReport& report) {
    std::vector<std::string> failures;
    const auto add = [&](const auto& of) {
        if (!of.failure.empty())
            failures.push_back(fmt::format("{} failed after {}: {}", of.name,
                                           counted(of.pictures, "frame"), of.failure));
    };
    for (const OutputState& output : report.outputs) add(output);
    for (const SinkState& sink : report.programme.sinks) add(sink);
    return failures;
}

double new_frames_per_second(const ProgrammeStats& programme) {
    return programme.duration_s > 0 ? static_cast<double>(programme.pictures) / programme.duration_s
                                    : 0;
}

std::vector<StepTime> step_times(const LiveReport& report) {
    std::vector<StepTime> steps;
    for (const auto& [name, ms] : {std::pair("capture", &report.rig_steps.capture_ms),
                                   {"rectify", &report.rig_steps.rectify_ms},
                                   {"match", &report.rig_steps.match_ms},
                                   {"pack", &report.rig_steps.pack_ms},
                                   {"network", &report.network_ms},
                                   {"decode", &report.decode_ms},
                                   {"prepare", &report.prepare_ms},
                                   {"render", &report.programme.render_ms},
                                   {"readback", &report.programme.readback_ms},
                                   {"encode", &report.encode_ms}})
        if (ms->count > 0) steps.push_back({name, *ms});
    return steps;
}

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
