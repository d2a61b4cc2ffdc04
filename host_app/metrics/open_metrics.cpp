#include "host_app/metrics/open_metrics.h"

#include <fmt/format.h>

#include "common/base/cli/version.h"

namespace vantage {
namespace {

double number(std::uint64_t count) { return static_cast<double>(count); }

void write_programme(const LiveReport& report, MetricText& text) {
    const ProgrammeStats& programme = report.programme;
    text.info("program", "This program.");
    text.sample(1, {{"version", version()},
                    {"synthesiser", report.synthesiser},
                    {"renderer", report.renderer}});
    text.gauge("rate_hz", "Configured picture rate.");
    text.sample(report.rate_hz);
    text.counter("ticks", "Ticks of the programme since its first picture.");
    text.sample(number(programme.ticks));
    text.counter("new_pictures", "Ticks with a new picture.");
    text.sample(number(programme.pictures));
    text.counter("reprojected_ticks",
                 "Ticks without a new picture, which showed the last one reprojected.");
    text.sample(number(programme.reprojected));
    text.counter("repeated_ticks",
                 "Ticks without a new picture, which showed the last one unchanged.");
    text.sample(number(programme.repeated));
    text.counter("missed_ticks", "Ticks that passed before the programme reached them.");
    text.sample(number(programme.missed));
    text.counter("replaced_pictures",
                 "Pictures replaced by a newer one before a tick showed them.");
    text.sample(number(programme.replaced));                                    // old name
    text.counter("superseded_pictures", "Deprecated: see replaced_pictures.");  // old name
    text.sample(number(programme.replaced));                                    // old name
    text.gauge("live", "1 while the programme shows what happens now.");
    text.sample(report.signal == SignalState::live ? 1 : 0);
    text.gauge("quality_share_ratio", "Share of time at each quality level; 0 is the best.");
    for (const auto& [work, shares] :
         {std::pair("render", &programme.render_shares), {"prepare", &programme.prepare_shares}})
        for (std::size_t level = 0; level < shares->size(); ++level)
            text.sample((*shares)[level], {{"work", work}, {"level", std::to_string(level)}});
    text.summary("tick_lateness_seconds", "From a tick to the output of its picture.");
    text.percentiles(programme.late_ms);
    text.summary("picture_interval_seconds", "Between two new pictures.");
    text.percentiles(programme.interval_ms);
    text.summary("exposure_to_picture_seconds", "From an exposure to the output of its picture.");
    text.percentiles(programme.latency_ms);
    text.summary("input_to_picture_seconds", "From operator input to the first picture with it.");
    text.percentiles(programme.input_ms);
    text.summary("hand_to_picture_seconds",  // old name
                 "Deprecated: see input_to_picture_seconds.");
    text.percentiles(programme.input_ms);
    text.summary("seek_to_picture_seconds", "From a jump in time to its picture.");
    text.percentiles(programme.seek_ms);
    text.summary("idle_to_best_seconds",
                 "From the last change of camera and time to the best picture.");
    text.percentiles(programme.rest_ms);
    text.summary("rest_to_best_seconds", "Deprecated: see idle_to_best_seconds.");
    text.percentiles(programme.rest_ms);
    text.summary("step_seconds", "Steps of a frame's way, of rigs the worst one's.");
    for (const StepTime& step : step_times(report))
        text.percentiles(step.ms, {{"step", step.name}});
    text.counter("faults", "Renderers and preparers that were recreated.");
    text.sample(report.faults);
    text.counter("gpu_resets", "GPU resets with recovery.");
    text.sample(report.contexts_lost);
    if (!report.corridor.now) return;
    text.gauge("coverage_ratio", "Share of the picture that the rigs cover.");
    text.sample(report.corridor.now->share);
}

void write_frame_sets(const LiveReport& report, MetricText& text) {
    text.counter("frame_sets", "Closed frame sets, complete or not.");
    text.sample(number(report.frame_sets_complete), {{"rigs", "all"}});
    text.sample(number(report.frame_sets_closed - report.frame_sets_complete), {{"rigs", "some"}});
    text.counter("instants", "Prepared instants, from frame sets or interpolated between two.");
    text.sample(number(report.instants_prepared), {{"of", "set"}});
    text.sample(number(report.instants_between), {{"of", "between"}});
    text.counter("frame_sets_left_out", "Frame sets that no instant was prepared from.");
    text.sample(number(report.frame_sets_replaced), {{"why", "replaced"}});
    text.sample(number(report.frame_sets_dropped), {{"why", "dropped"}});
    text.counter("sets_left_out", "Deprecated: see frame_sets_left_out.");
    text.sample(number(report.frame_sets_replaced), {{"why", "superseded"}});  // old name
    text.sample(number(report.frame_sets_dropped), {{"why", "dropped"}});
}

void write_rigs(const LiveReport& report, MetricText& text) {
    text.counter("stage_reloads", "Requests to reload the stage file, by result.");
    text.sample(number(report.reloads.done), {{"result", "done"}});
    text.sample(number(report.reloads.refused), {{"result", "refused"}});
    text.gauge("rig_up", "1 while the rig is connected; none for a removed rig.");
    for (const RigAccount& rig : report.rigs)
        if (!rig.status.is_removed)
            text.sample(rig.status.connected ? 1 : 0, {{"rig", rig.status.rig}});
    const auto write_frames = [&](bool by_old_keys) {
        for (const RigAccount& rig : report.rigs)
            for (const CounterGroup& group : counters_of(rig))
                for (const Counter& counter : group.counters)
                    text.sample(number(counter.value),
                                {{"rig", rig.status.rig},
                                 {"place", group.key},
                                 {"result",
                                  by_old_keys && counter.old_key ? counter.old_key : counter.key}});
    };
    text.counter("rig_frame_results", "Frames by place and result, as the summary has them.");
    write_frames(false);
    text.counter("rig_frames", "Deprecated: see rig_frame_results.");
    write_frames(true);
    text.counter("rig_outages", "Times that the rig was away.");
    for (const RigAccount& rig : report.rigs)
        text.sample(number(rig.status.outages), {{"rig", rig.status.rig}});
    text.counter("rig_outage_seconds", "Total time of the rig's outages.");
    for (const RigAccount& rig : report.rigs)
        text.sample(rig.status.outage_s, {{"rig", rig.status.rig}});
    text.summary("rig_latency_seconds", "From exposure to decoded.");
    for (const RigAccount& rig : report.rigs)
        text.percentiles(rig.status.latency_ms, {{"rig", rig.status.rig}});
    text.gauge("rig_temperature_celsius", "The rig's hottest sensor.");
    for (const RigAccount& rig : report.rigs)
        if (rig.status.health.temperature_c)
            text.sample(*rig.status.health.temperature_c, {{"rig", rig.status.rig}});
    text.gauge("rig_under_voltage", "1 while the rig's supply voltage is too low.");
    for (const RigAccount& rig : report.rigs)
        text.sample(rig.status.health.under_voltage ? 1 : 0, {{"rig", rig.status.rig}});
    text.counter("rig_refused_connections",
                 "Connections that are not from a host, at the rig and at relays.");
    for (const RigAccount& rig : report.rigs)
        text.sample(number(rig.status.health.refused_connections), {{"rig", rig.status.rig}});
    text.gauge("rig_clock_disciplined",
               "1 while PTP disciplines the rig's clock, or it is this one's.");
    for (const RigAccount& rig : report.rigs)
        text.sample(rig.status.same_clock || rig.status.sync.disciplined ? 1 : 0,
                    {{"rig", rig.status.rig}});
    const auto write_background = [&] {
        for (const RigAccount& rig : report.rigs)
            if (rig.background) text.sample(rig.background->known, {{"rig", rig.status.rig}});
    };
    text.gauge("rig_background_known_ratio", "Learnt share of the rig's background.");
    write_background();
    text.gauge("rig_set_known_ratio", "Deprecated: see rig_background_known_ratio.");
    write_background();
}

void write_outputs(const LiveReport& report, MetricText& text) {
    text.gauge("output_up", "1 while the output is running.");
    for (const OutputState& output : report.outputs)
        text.sample(output.phase == OutputPhase::on ? 1 : 0, {{"output", output.name}});
    text.counter("output_pictures", "Pictures that the output took or dropped.");
    for (const OutputState& output : report.outputs) {
        text.sample(number(output.pictures), {{"output", output.name}, {"result", "taken"}});
        text.sample(number(output.dropped), {{"output", output.name}, {"result", "left_out"}});
    }
    text.counter("output_bytes", "Bytes that the output wrote.");
    for (const OutputState& output : report.outputs)
        text.sample(number(output.bytes), {{"output", output.name}});
    text.gauge("output_queued_pictures", "Pictures that wait for the output.");
    for (const OutputState& output : report.outputs)
        text.sample(number(output.queued), {{"output", output.name}});
    text.counter("output_failures", "Number of failures of the output.");
    for (const OutputState& output : report.outputs)
        text.sample(number(output.failures), {{"output", output.name}});
}

void write_take(const TakeState& take, MetricText& text) {
    text.gauge("take_recording", "1 while a take is recorded.");
    text.sample(take.phase == TakePhase::recording ? 1 : 0);
    text.gauge("take_frames", "Frames in the take.");
    text.sample(number(take.frames));
    text.gauge("take_missing_frames", "Frames missing from the take.");
    text.sample(number(take.gaps));
    text.gauge("take_bytes", "Size of the take.");
    text.sample(number(take.bytes));
}

void write_ports(const LiveReport& report, MetricText& text) {
    text.counter("control_messages", "Remote control messages by outcome.");
    for (const PortState& port : report.ports)
        for (const auto& [result, count] : {std::pair("obeyed", port.stats.obeyed),
                                            {"unknown", port.stats.unknown},
                                            {"malformed", port.stats.malformed},
                                            {"dropped", port.stats.dropped}})
            text.sample(number(count), {{"port", port.name}, {"result", result}});
}

}  // namespace

std::string to_open_metrics(const LiveReport& report) {
    MetricText text;
    write_programme(report, text);
    write_frame_sets(report, text);
    write_rigs(report, text);
    write_outputs(report, text);
    if (report.take) write_take(*report.take, text);
    write_ports(report, text);
    return text.whole();
}

namespace {

constexpr double ms_per_s = 1000;

std::string escaped(std::string_view text) {
    std::string safe;
    for (const char c : text) {
        if (c == '\n') {
            safe += "\\n";
            continue;
        }
        if (c == '"' || c == '\\') safe += '\\';
        safe += c;
    }
    return safe;
}

}  // namespace

void MetricText::family(std::string_view name, std::string_view kind, std::string_view help) {
    name_ = fmt::format("vantage_{}", name);
    kind_ = kind;
    text_ += fmt::format("# TYPE {} {}\n# HELP {} {}\n", name_, kind_, name_, escaped(help));
}

void MetricText::line(std::string_view ending, double value, Labels labels,
                      std::string_view quantile) {
    std::string inside;
    const auto add = [&](std::string_view name, std::string_view label) {
        inside += fmt::format("{}{}=\"{}\"", inside.empty() ? "" : ",", name, escaped(label));
    };
    for (const auto& [name, label] : labels) add(name, label);
    if (!quantile.empty()) add("quantile", quantile);
    text_ += fmt::format("{}{}{} {}\n", name_, ending,
                         inside.empty() ? "" : fmt::format("{{{}}}", inside), value);
}

void MetricText::sample(double value, Labels labels) {
    line(kind_ == "counter" ? "_total" : kind_ == "info" ? "_info" : "", value, labels);
}

void MetricText::percentiles(const Percentiles& ms, Labels labels) {
    if (ms.count == 0) return;
    for (const auto& [quantile, value] :
         {std::pair("0.5", ms.p50), {"0.95", ms.p95}, {"0.99", ms.p99}, {"1", ms.max}})
        line("", value / ms_per_s, labels, quantile);
    line("_count", static_cast<double>(ms.count), labels);
}

}  // namespace vantage
