#include <algorithm>

#include <fmt/format.h>

#include "common/base/counted.h"
#include "host_app/session/report/live_report.h"

namespace vantage {
namespace {

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

/// Lists troubles, outages, clocks and faults of the rigs.
std::string rig_remarks(const LiveReport& report) {
    std::string text;
    for (const RigAccount& rig : report.rigs) {
        const RigStatus& status = rig.status;
        if (!status.connected)
            text += fmt::format("{} is {}\n", status.rig, full_state_of(status));
        else if (!status.same_clock)
            text += fmt::format("{}: {}\n", status.rig, clock_text(status));
        if (const std::string trouble = trouble_of(status); status.connected && !trouble.empty())
            text += fmt::format("{}: {}\n", status.rig, trouble);
        if (const std::string outages = outages_of(status); !outages.empty())
            text += fmt::format("{}: {}\n", status.rig, outages);
        for (const std::string& worry : computer_worries_of(rig.status))
            text += fmt::format("{}: {}\n", rig.status.rig, worry);
        if (const std::string pulses = pulse_text(rig.status.sync); !pulses.empty())
            text += fmt::format("{}: {}\n", rig.status.rig, pulses);
        if (!status.datagram_trouble.empty())
            text += fmt::format("{}: {}\n", status.rig, road_worry(status));
        if (!rig.status.last_error.empty())
            text +=
                fmt::format("{}: the last fault was: {}\n", rig.status.rig, rig.status.last_error);
    }
    return text;
}

std::string corridor_text(const LiveReport& report) {
    const CorridorStats& stats = report.corridor;
    if (!stats.now) return "";
    std::string text = fmt::format(
        "the rigs cover {:.0f} % of the last picture and at least {:.0f} % of every one",
        100 * stats.now->share, 100 * stats.least_share);
    if (stats.edge_s > 0 || stats.beyond_s > 0)
        text += fmt::format(
            "; the camera was {:.1f} s at the edge of the corridor and {:.1f} s outside it",
            stats.edge_s, stats.beyond_s);
    return text + '\n';
}

std::string take_text(const TakeState& take) {
    std::string text = fmt::format(
        "take: {}, {:.1f} s, {} frames, {} missing, {:.1f} MB, {:.1f} MB/s, each written within "
        "{:.0f} ms\n",
        take.path, take.duration_s, take.frames, take.gaps, static_cast<double>(take.bytes) / 1e6,
        take.mb_s, take.longest_unwritten_ms);
    for (const TakeState::Rig& rig : take.rigs)
        if (rig.dropped + rig.refused > 0)
            text += fmt::format(
                "take: rig {}: dropped {} frames because the disk was too slow and {} that did not "
                "fit the take\n",
                rig.name, rig.dropped, rig.refused);
    if (take.has_sound)
        text += fmt::format(
            "take: {:.1f} s of sound, {} samples dropped because the disk was too slow\n",
            take.sound_s, take.sound_dropped);
    if (!take.failure.empty()) text += fmt::format("take: {}\n", take.failure);
    return text;
}

std::string sound_text(const SoundState& sound) {
    const auto ms = [](std::uint64_t samples) {
        return 1000 * static_cast<double>(samples) / sound_rate_hz;
    };
    std::string text = fmt::format(
        "sound: {}, {}, {:.1f} s, delayed by {:.0f} ms; {:.0f} ms missing, {:.0f} ms dropped, {}; "
        "its clock is {:.0f} ppm fast",
        sound.name, key_of(sound.phase), ms(sound.played) / 1000, sound.delay_ms, ms(sound.missing),
        ms(sound.dropped), counted(sound.jumps, "jump"), sound.drift_ppm);
    if (sound.failures > 0) text += fmt::format("; failed {}", counted_times(sound.failures));
    if (!sound.failure.empty()) text += ": " + sound.failure;
    return text + '\n';
}

std::string output_text(const OutputState& output) {
    if (output.offered == 0 && output.failures == 0)
        return fmt::format("output: {} was not started\n", output.name);
    std::string text = fmt::format("output: {}{}{}, {}, {:.1f} MB, {} dropped because it was busy",
                                   output.name, output.encoder.empty() ? "" : " by ",
                                   output.encoder, counted(output.pictures, "frame"),
                                   static_cast<double>(output.bytes) / 1e6, output.dropped);
    if (output.unheard > 0)
        text += fmt::format(", {} without a receiver", counted(output.unheard, "frame"));
    if (output.silenced > 0)
        text += fmt::format(", {} without sound", counted(output.silenced, "frame"));
    if (output.failures > 0) text += fmt::format(", failed {}", counted_times(output.failures));
    return text + '\n';
}

std::string line_of(const char* what, const Percentiles& ms) {
    return fmt::format("{}: p50 {:.0f} ms, p95 {:.0f}, p99 {:.0f}, max {:.0f}\n", what, ms.p50,
                       ms.p95, ms.p99, ms.max);
}

std::string steps_text(const LiveReport& report) {
    std::string text;
    text += fmt::format("{:<10}  {:>8}  {:>8}\n", "step", "p50 ms", "p95 ms");
    for (const StepTime& step : step_times(report))
        text += fmt::format("{:<10}  {:>8.2f}  {:>8.2f}\n", step.name, step.ms.p50, step.ms.p95);
    return text;
}

std::string results_text(const LiveReport& report) {
    std::string text;
    if (report.faults > 0)
        text += fmt::format("faults of renderers and preparers, which were created again: {}\n",
                            report.faults);
    if (report.contexts_lost > 0)
        text += fmt::format("GPU resets, after which everything was created again: {}\n",
                            report.contexts_lost);
    for (const std::string& failure : failures_of(report)) text += failure + '\n';
    if (report.stereoscopy)
        text +=
            fmt::format("{}: eyes {:.1f} mm apart, converging at {:.2f} m\n",
                        to_json(*report.stereoscopy)["layout"].get<std::string>(),
                        1000 * report.stereoscopy->interaxial_m, report.stereoscopy->convergence_m);
    if (report.source_map) {
        text += "pixels of the last picture by rig:";
        for (const auto& [rig, share] : report.source_map->rigs)
            text += fmt::format(" {} {:.1f} %,", rig, 100 * share);
        text += fmt::format(" inpainted {:.1f} %, background {:.1f} %\n",
                            100 * report.source_map->filled, 100 * report.source_map->remembered);
    }
    for (const DeckDevice& wheel : report.wheels)
        text += fmt::format("wheel: {} at {}, {} reports, {} of them unreadable{}{}\n", wheel.model,
                            wheel.place.path, wheel.reports, wheel.unread,
                            wheel.fault.empty() ? "" : "; ", wheel.fault);
    for (const PortState& port : report.ports)
        text += fmt::format(
            "control: {}, {} executed, {} unknown, {} malformed, {} over the rate limit{}{}\n",
            port.name, counted(port.stats.obeyed, "message"), port.stats.unknown,
            port.stats.malformed, port.stats.dropped,
            port.failure.empty() ? "" : "; failed: ", port.failure);
    for (const PortState& port : report.ports)
        if (!port.stats.told.empty())
            text += fmt::format("control: {}: {}\n", port.name, port.stats.told);
    if (report.take) text += take_text(*report.take);
    if (!report.reloads.sentence.empty()) text += report.reloads.sentence + '\n';
    if (!report.saved_background.empty())
        text += fmt::format("background saved to {}\n", report.saved_background);
    if (report.sound) text += sound_text(*report.sound);
    for (const OutputState& output : report.outputs) text += output_text(output);
    return text;
}

}  // namespace

std::string counters_legend() {
    return R"(Every frame since this host connected is counted in one place.
At the rig: missed (no picture for a pulse), late (a step was still busy), published.
On the way: skipped (this host did not request it), dropped at rig (the queue to this host was full),
sent, lost (sent, then the connection broke).
At this host: damaged (not readable), dropped at host (the decoder was busy), late (its frame set was
closed), duplicate, unsynchronised (it has no pulse of the stage), out of step (its rig counts pulses
differently from the others), in frame sets. Of those in frame sets: fused (in an instant), replaced by
newer (before an instant was due), dropped at start (before the session took any).
)";
}

std::string shares_text(const std::vector<double>& shares) {
    std::string text;
    for (std::size_t level = 0; level < shares.size(); ++level)
        if (shares[level] > 0.005)
            text +=
                fmt::format("{}{}: {:.0f} %", text.empty() ? "" : ", ", level, 100 * shares[level]);
    return text.empty() ? "none" : text;
}

std::string to_text(const LiveReport& report) {
    const ProgrammeStats& programme = report.programme;
    std::string text = fmt::format(
        "\n{:g} fps requested, {:.1f} new frames per second: {} frames of {}x{} in {:.1f} s; of {} "
        "ticks {} reprojected and {} repeated the last frame, {} missed; {} frames replaced by "
        "newer (synthesiser {}, on {})\n",
        report.rate_hz, new_frames_per_second(programme), programme.pictures,
        report.format.width_px, report.format.height_px, programme.duration_s, programme.ticks,
        programme.reprojected, programme.repeated, programme.missed, programme.replaced,
        report.synthesiser,  // old name
        report.renderer);
    text += line_of("after the tick", programme.late_ms);
    text += line_of("between two frames", programme.interval_ms);
    if (programme.latency_ms.count > 0)
        text += line_of("exposure to picture", programme.latency_ms);
    if (programme.input_ms.count > 0) text += line_of("input to picture", programme.input_ms);
    if (programme.rest_ms.count > 0)
        text += line_of("idle until the best picture", programme.rest_ms);
    if (programme.seek_ms.count > 0) {
        text += line_of("seek to picture", programme.seek_ms);
        text += line_of("  waiting for the previous instant", programme.seek_steps_ms.wait);
        text += line_of("  reading and decoding", programme.seek_steps_ms.fetch);
        text += line_of("  preparing", programme.seek_steps_ms.prepare);
        text += line_of("  rendering, until its tick", programme.seek_steps_ms.picture);
    }
    if (programme.preview_pictures > 0)
        text += line_of(
            fmt::format("{} of the preview, each", counted(programme.preview_pictures, "frame"))
                .c_str(),
            programme.preview_ms);
    text +=
        fmt::format("levels of quality (0 is the best) by time: rendering {}; preparing {}\n",
                    shares_text(programme.render_shares), shares_text(programme.prepare_shares));
    if (!report.played.empty()) {
        text += fmt::format("{}: played {} instants and {} between pulses, the last of pulse {}\n",
                            report.played, report.instants_prepared, report.instants_between,
                            report.shown_pulse);
        text += corridor_text(report) + steps_text(report) + results_text(report);
        return text;
    }
    text += fmt::format(
        "{} frame sets, {} complete and {} partial: {} prepared as instants, {} replaced by newer, "
        "{} dropped\n",
        report.frame_sets_closed, report.frame_sets_complete,
        report.frame_sets_closed - report.frame_sets_complete, report.instants_prepared,
        report.frame_sets_replaced, report.frame_sets_dropped);
    text += corridor_text(report) + '\n' + rig_tables(report);
    if (!report.rigs.empty()) text += counters_legend() + '\n';
    text += fmt::format("signal at the end: {}\n", title_of(report.signal));
    text += rig_remarks(report);
    return text + steps_text(report) + results_text(report);
}

}  // namespace vantage
