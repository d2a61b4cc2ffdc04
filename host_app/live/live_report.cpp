#include "host_app/live/live_report.h"

#include <algorithm>
#include <numbers>

#include <fmt/format.h>

#include "common/wire/status_report.h"

namespace vantage {
namespace {

/// One counter of a rig: its key for machines and its heading for people.
struct Counter {
    const char *key, *heading;
    std::uint64_t value;
};

/// Counters of one place on the way, which together say what became of every frame there.
struct CounterGroup {
    const char *key, *title;
    std::vector<Counter> counters;
};

std::vector<CounterGroup> counters_of(const RigAccount& rig) {
    const RigStatus& s = rig.status;
    const RigCounters& r = s.rig_counters;
    return {{"rig",
             "at the rig, since it started",
             {{"captured", "captured", r.captured},
              {"missed", "missed", r.missed},
              {"late", "late", r.late},
              {"published", "published", r.published}}},
            {"link",
             "on the way to this host",
             {{"offered", "offered", s.link.offered},
              {"send_dropped", "pushed out", s.link.send_dropped},
              {"thinned", "thinned", s.link.thinned},
              {"sent", "sent", s.link.sent},
              {"lost", "lost", s.lost}}},
            {"host",
             "at this host",
             {{"received", "received", s.received},
              {"undecodable", "damaged", s.undecodable},
              {"queue_dropped", "host busy", s.queue_dropped},
              {"late", "late", s.late},
              {"duplicate", "duplicate", s.duplicate},
              {"unsynchronized", "unsynced", s.unsynchronized},
              {"out_of_step", "out of step", s.out_of_step},
              {"in_sets", "in sets", s.in_sets},
              {"fused", "fused", rig.fused},
              {"superseded", "superseded", rig.superseded}}}};
}

std::string rig_tables(const LiveReport& report) {
    if (report.rigs.empty()) return "";
    std::size_t name_width = 4;
    for (const RigAccount& rig : report.rigs)
        name_width = std::max(name_width, rig.status.rig.size());
    const auto width = [](const Counter& counter) {
        return std::max<std::size_t>(8, std::string_view(counter.heading).size());
    };
    std::string text;
    const std::vector<CounterGroup> groups = counters_of(report.rigs.front());
    for (std::size_t g = 0; g < groups.size(); ++g) {
        text += fmt::format("frames {}\n{:{}}", groups[g].title, "", name_width);
        for (const Counter& counter : groups[g].counters)
            text += fmt::format("  {:>{}}", counter.heading, width(counter));
        text += '\n';
        for (const RigAccount& rig : report.rigs) {
            text += fmt::format("{:<{}}", rig.status.rig, name_width);
            const std::vector<CounterGroup> of_rig = counters_of(rig);
            for (const Counter& counter : of_rig[g].counters)
                text += fmt::format("  {:>{}}", counter.value, width(counter));
            text += '\n';
        }
        text += '\n';
    }
    return text;
}

/// Heat and supply; nothing of a rig that is away, for what it said last may not hold any more.
std::vector<std::string> computer_worries_of(const RigStatus& status) {
    // A Raspberry Pi's processors slow down from here on.
    constexpr float hot_c = 80;
    std::vector<std::string> worries;
    if (!status.connected) return worries;
    if (status.health.temperature_c.value_or(0) >= hot_c)
        worries.push_back(fmt::format("{:.0f} C, it slows down from {:.0f}",
                                      *status.health.temperature_c, hot_c));
    if (status.health.under_voltage) worries.emplace_back("its supply sags");
    return worries;
}

/// What a person must know of a rig beyond its numbers.
std::string rig_remarks(const LiveReport& report) {
    std::string text;
    for (const RigAccount& rig : report.rigs) {
        if (!rig.status.connected)
            text += fmt::format("{} is {}\n", rig.status.rig, state_of(rig.status));
        else if (!rig.status.same_clock)
            text += fmt::format("{}: {}\n", rig.status.rig, clock_text(rig.status));
        for (const std::string& worry : computer_worries_of(rig.status))
            text += fmt::format("{}: {}\n", rig.status.rig, worry);
        if (const std::string pulses = pulse_text(rig.status.sync); !pulses.empty())
            text += fmt::format("{}: {}\n", rig.status.rig, pulses);
        if (!rig.status.last_error.empty())
            text +=
                fmt::format("{}: the last fault was: {}\n", rig.status.rig, rig.status.last_error);
    }
    return text;
}

}  // namespace

std::string state_of(const RigStatus& status) {
    if (!status.refused.empty()) return "refused: " + status.refused;
    return status.connected ? "connected" : "disconnected";
}

std::vector<std::string> worries_of(const RigStatus& status) {
    std::vector<std::string> worries = computer_worries_of(status);
    if (status.connected && !status.same_clock && !status.sync.disciplined)
        worries.emplace_back(clocks_not_disciplined);
    if (status.connected)
        if (std::string worry = tai_worry(status); !worry.empty())
            worries.push_back(std::move(worry));
    return worries;
}

nlohmann::ordered_json to_json(const LiveReport& report) {
    nlohmann::ordered_json json{
        {"pictures", report.pictures},       {"width_px", report.width_px},
        {"height_px", report.height_px},     {"rate_hz", report.rate_hz},
        {"duration_s", report.duration_s},   {"skipped_ticks", report.skipped_ticks},
        {"synthesiser", report.synthesiser}, {"renderer", report.renderer}};
    constexpr double deg = 180 / std::numbers::pi;
    const OrbitView& view = report.view;
    json["camera"] = {{"azimuth_deg", view.azimuth_rad * deg},
                      {"elevation_deg", view.elevation_rad * deg},
                      {"distance_m", view.distance_m},
                      {"field_of_view_deg", view.field_of_view_rad * deg},
                      {"pivot_m", {view.pivot_m.x(), view.pivot_m.y(), view.pivot_m.z()}}};
    json["sets"] = {{"closed", report.sets_closed},
                    {"complete", report.sets_complete},
                    {"partial", report.sets_closed - report.sets_complete},
                    {"fused", report.sets_fused},
                    {"superseded", report.sets_superseded},
                    {"dropped", report.sets_dropped}};
    json["rigs"] = nlohmann::ordered_json::array();
    for (const RigAccount& rig : report.rigs) {
        nlohmann::ordered_json entry{{"name", rig.status.rig}, {"state", state_of(rig.status)}};
        for (const CounterGroup& group : counters_of(rig))
            for (const Counter& counter : group.counters)
                entry[group.key][counter.key] = counter.value;
        if (rig.harmony) {
            const Eigen::Vector3d gain = rig.harmony->gain();
            entry["colour"] = {{"gains", {gain[0], gain[1], gain[2]}},
                               {"shared_points", rig.harmony->samples}};
        }
        entry["latency_ms"] = to_json(rig.status.latency_ms);
        entry["clock"] = clock_text(rig.status);
        entry["same_clock"] = rig.status.same_clock;
        entry["sync"] = to_json(rig.status.sync);
        entry["health"] = to_json(rig.status.health);
        if (!rig.status.last_error.empty()) entry["last_error"] = rig.status.last_error;
        json["rigs"].push_back(std::move(entry));
    }
    json["stages_ms"] = nlohmann::ordered_json::object();
    for (const StageTime& time : report.stages)
        if (time.ms.count > 0) json["stages_ms"][time.stage] = to_json(time.ms);
    json["latency_ms"] = to_json(report.latency_ms);
    if (report.stereoscopy) json["stereoscopic"] = to_json(*report.stereoscopy);
    if (report.novelty) json["novelty"] = to_json(*report.novelty);
    for (const DeckDevice& wheel : report.wheels)
        json["wheels"].push_back({{"name", wheel.model},
                                  {"path", wheel.place.path},
                                  {"usable", wheel.usable},
                                  {"fault", wheel.fault},
                                  {"reports", wheel.reports},
                                  {"unread", wheel.unread}});
    if (!report.film.empty())
        json["film"] = {{"path", report.film},
                        {"pictures", report.film_pictures},
                        {"dropped", report.film_dropped}};
    return json;
}

std::string to_text(const LiveReport& report) {
    std::string text = fmt::format(
        "\n{} pictures of {}x{} in {:.1f} s, {} output ticks of {:g} Hz passed without one "
        "(synthesiser {}, on {})\n",
        report.pictures, report.width_px, report.height_px, report.duration_s, report.skipped_ticks,
        report.rate_hz, report.synthesiser, report.renderer);
    text += fmt::format(
        "{} frame sets, {} complete and {} partial: {} fused, {} superseded by a newer one, {} "
        "dropped\n\n",
        report.sets_closed, report.sets_complete, report.sets_closed - report.sets_complete,
        report.sets_fused, report.sets_superseded, report.sets_dropped);
    text += rig_tables(report);
    text += rig_remarks(report);
    text += fmt::format("{:<10}  {:>8}  {:>8}\n", "stage", "p50 ms", "p95 ms");
    for (const StageTime& time : report.stages)
        if (time.ms.count > 0)
            text +=
                fmt::format("{:<10}  {:>8.2f}  {:>8.2f}\n", time.stage, time.ms.p50, time.ms.p95);
    text += fmt::format(
        "\nexposure to picture: p50 {:.1f} ms, p95 {:.1f}, p99 {:.1f}, max {:.1f}\n",
        report.latency_ms.p50, report.latency_ms.p95, report.latency_ms.p99, report.latency_ms.max);
    if (report.stereoscopy)
        text +=
            fmt::format("side by side: eyes {:.1f} mm apart, converging at {:.2f} m\n",
                        1000 * report.stereoscopy->interaxial_m, report.stereoscopy->convergence_m);
    if (report.novelty) {
        text += "pixels of the last picture by rig:";
        for (const auto& [rig, share] : report.novelty->rigs)
            text += fmt::format(" {} {:.1f} %,", rig, 100 * share);
        text += fmt::format(" filled {:.1f} % remembered {:.1f} %\n", 100 * report.novelty->filled,
                            100 * report.novelty->remembered);
    }
    for (const DeckDevice& wheel : report.wheels)
        text += fmt::format("wheel: {} at {}, {} reports, {} of them not understood{}{}\n",
                            wheel.model, wheel.place.path, wheel.reports, wheel.unread,
                            wheel.fault.empty() ? "" : "; ", wheel.fault);
    if (!report.film.empty())
        text += fmt::format("film: {}, {} pictures, {} left out because the encoder was busy\n",
                            report.film, report.film_pictures, report.film_dropped);
    return text;
}

}  // namespace vantage
