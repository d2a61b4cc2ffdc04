#include "host_app/live/live_report.h"

#include <algorithm>

#include <fmt/format.h>

namespace vantage {
namespace {

nlohmann::ordered_json to_json(const Percentiles& p) {
    return {{"count", p.count}, {"p50", p.p50}, {"p95", p.p95}, {"p99", p.p99}, {"max", p.max}};
}

/// One counter of a rig: its key for machines, its heading for people, and where it stands.
struct Counter {
    const char *key, *heading;
    std::uint64_t value;
};

std::vector<Counter> counters_of(const RigAccount& rig) {
    const RigStatus& s = rig.status;
    const RigCounters& r = s.rig_counters;
    return {{"captured", "captured", r.captured},
            {"missed", "missed", r.missed},
            {"rig_late", "rig late", r.late},
            {"send_dropped", "not sent", r.send_dropped},
            {"published", "sent", r.published},
            {"received", "received", s.received},
            {"undecodable", "damaged", s.undecodable},
            {"late", "late", s.late},
            {"queue_dropped", "dropped", s.queue_dropped},
            {"in_sets", "in sets", s.in_sets},
            {"fused", "fused", rig.fused},
            {"superseded", "superseded", rig.superseded}};
}

std::string rig_table(const LiveReport& report) {
    std::size_t name_width = 3;
    for (const RigAccount& rig : report.rigs)
        name_width = std::max(name_width, rig.status.rig.size());
    std::string text = fmt::format("{:<{}}", "rig", name_width);
    if (!report.rigs.empty())
        for (const Counter& counter : counters_of(report.rigs.front()))
            text += fmt::format("  {:>8}", counter.heading);
    text += "  exposure to decoded, p50 / p95 ms\n";
    for (const RigAccount& rig : report.rigs) {
        text += fmt::format("{:<{}}", rig.status.rig, name_width);
        for (const Counter& counter : counters_of(rig))
            text += fmt::format("  {:>{}}", counter.value,
                                std::max<std::size_t>(8, std::string(counter.heading).size()));
        text +=
            fmt::format("  {:.1f} / {:.1f}", rig.status.latency_ms.p50, rig.status.latency_ms.p95);
        if (!rig.status.connected) text += "  " + state_of(rig.status);
        if (!rig.status.last_error.empty()) text += "  last fault: " + rig.status.last_error;
        text += '\n';
    }
    return text;
}

}  // namespace

std::string state_of(const RigStatus& status) {
    if (!status.refused.empty()) return "refused: " + status.refused;
    return status.connected ? "connected" : "disconnected";
}

nlohmann::ordered_json to_json(const LiveReport& report) {
    nlohmann::ordered_json json{
        {"pictures", report.pictures},       {"width_px", report.width_px},
        {"height_px", report.height_px},     {"rate_hz", report.rate_hz},
        {"duration_s", report.duration_s},   {"skipped_ticks", report.skipped_ticks},
        {"synthesiser", report.synthesiser}, {"renderer", report.renderer}};
    json["sets"] = {{"closed", report.sets_closed},
                    {"complete", report.sets_complete},
                    {"partial", report.sets_closed - report.sets_complete},
                    {"fused", report.sets_fused},
                    {"superseded", report.sets_superseded},
                    {"dropped", report.sets_dropped}};
    json["rigs"] = nlohmann::ordered_json::array();
    for (const RigAccount& rig : report.rigs) {
        nlohmann::ordered_json entry{{"name", rig.status.rig}, {"state", state_of(rig.status)}};
        for (const Counter& counter : counters_of(rig)) entry[counter.key] = counter.value;
        entry["latency_ms"] = to_json(rig.status.latency_ms);
        if (!rig.status.last_error.empty()) entry["last_error"] = rig.status.last_error;
        json["rigs"].push_back(std::move(entry));
    }
    json["stages_ms"] = nlohmann::ordered_json::object();
    for (const StageTime& time : report.stages)
        if (time.ms.count > 0) json["stages_ms"][time.stage] = to_json(time.ms);
    json["latency_ms"] = to_json(report.latency_ms);
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
    text += rig_table(report);
    text += fmt::format("\n{:<10}  {:>8}  {:>8}\n", "stage", "p50 ms", "p95 ms");
    for (const StageTime& time : report.stages)
        if (time.ms.count > 0)
            text +=
                fmt::format("{:<10}  {:>8.2f}  {:>8.2f}\n", time.stage, time.ms.p50, time.ms.p95);
    text += fmt::format(
        "\nexposure to picture: p50 {:.1f} ms, p95 {:.1f}, p99 {:.1f}, max {:.1f}\n",
        report.latency_ms.p50, report.latency_ms.p95, report.latency_ms.p99, report.latency_ms.max);
    if (!report.film.empty())
        text += fmt::format("film: {}, {} pictures, {} left out because the encoder was busy\n",
                            report.film, report.film_pictures, report.film_dropped);
    return text;
}

}  // namespace vantage
