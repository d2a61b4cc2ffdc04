#include "host_app/live/live_report.h"

#include <algorithm>
#include <numbers>

#include <fmt/format.h>

#include "common/base/counted.h"
#include "common/wire/status_report.h"

namespace vantage {
namespace {

std::string times(std::uint64_t n) {
    return n == 1 ? std::string("once") : fmt::format("{} times", n);
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
        if (!rig.status.last_error.empty())
            text +=
                fmt::format("{}: the last fault was: {}\n", rig.status.rig, rig.status.last_error);
    }
    return text;
}

nlohmann::ordered_json corridor_json(const LiveReport& report) {
    const CorridorBooks& books = report.corridor;
    nlohmann::ordered_json json{
        {"coverage", books.now->share},     {"place", key_of(Corridor::place_of(books.now->share))},
        {"loss", key_of(books.now->loss)},  {"least_coverage", books.least_share},
        {"edge_s", books.edge_s},           {"beyond_s", books.beyond_s},
        {"free_flight", report.free_flight}};
    json["move_beyond"] = nlohmann::ordered_json::array();
    for (const UncoveredPart& part : report.uncovered)
        json["move_beyond"].push_back({{"from_s", part.from_s},
                                       {"to_s", part.to_s},
                                       {"least_coverage", part.least.share},
                                       {"loss", key_of(part.least.loss)}});
    return json;
}

std::string corridor_text(const LiveReport& report) {
    const CorridorBooks& books = report.corridor;
    if (!books.now) return "";
    std::string text =
        fmt::format("the rigs cover {:.0f} % of the last picture, {:.0f} % at the least",
                    100 * books.now->share, 100 * books.least_share);
    if (books.edge_s > 0 || books.beyond_s > 0)
        text += fmt::format(
            "; the camera was {:.1f} s at the edge of their corridor and {:.1f} s "
            "beyond its end",
            books.edge_s, books.beyond_s);
    return text + '\n';
}

nlohmann::ordered_json time_json(const LiveReport& report) {
    const TransportState& time = report.time;
    nlohmann::ordered_json json{{"shown_pulse", report.shown_pulse}, {"speed", time.speed}};
    if (time.pulse) json["pulse"] = *time.pulse;
    if (time.in) json["in"] = *time.in;
    if (time.out) json["out"] = *time.out;
    json["loops"] = time.loops;
    json["replay"] = name_of(report.replay.mode);
    if (report.replay.book)
        json["clips"] = {{"clips", report.replay.book->clips.size()},
                         {"entries", report.replay.book->list.size()},
                         {"programme_speed", report.replay.book->programme_speed}};
    if (!report.played.empty()) json["take"] = report.played;
    if (report.past)
        json["past"] = {
            {"sets", report.past->sets},
            {"bytes", report.past->bytes},
            {"duration_s", static_cast<double>(report.past->newest - report.past->oldest) /
                               report.pulse_rate_hz}};
    return json;
}

const char* key_of(TakePhase phase) {
    switch (phase) {
        case TakePhase::none:
            break;
        case TakePhase::opening:
            return "opening";
        case TakePhase::recording:
            return "recording";
        case TakePhase::failed:
            return "failed";
    }
    return "ended";
}

nlohmann::ordered_json take_json(const TakeState& take) {
    nlohmann::ordered_json json{{"path", take.path},
                                {"takes", take.takes},
                                {"state", key_of(take.phase)},
                                {"failure", take.failure},
                                {"frames", take.frames},
                                {"gaps", take.gaps},
                                {"bytes", take.bytes},
                                {"mb_s", take.mb_s},
                                {"duration_s", take.duration_s},
                                {"disk_mb_s", take.disk_mb_s},
                                {"longest_unwritten_ms", take.longest_unwritten_ms}};
    if (take.has_sound) {
        json["sound_s"] = take.sound_s;
        json["sound_dropped_samples"] = take.sound_dropped;
    }
    for (const TakeState::Rig& rig : take.rigs)
        json["rigs"].push_back({{"name", rig.name},
                                {"frames", rig.frames},
                                {"dropped", rig.dropped},
                                {"refused", rig.refused}});
    return json;
}

std::string take_text(const TakeState& take) {
    std::string text = fmt::format(
        "take: {}, {:.1f} s, {} frames and {} missing, {:.1f} MB, {:.1f} MB a second, written "
        "{:.0f} ms after they came at most\n",
        take.path, take.duration_s, take.frames, take.gaps, static_cast<double>(take.bytes) / 1e6,
        take.mb_s, take.longest_unwritten_ms);
    for (const TakeState::Rig& rig : take.rigs)
        if (rig.dropped + rig.refused > 0)
            text += fmt::format(
                "take: of rig {} are {} frames left out since they came faster than they could be "
                "written, and {} that did not fit\n",
                rig.name, rig.dropped, rig.refused);
    if (take.has_sound)
        text += fmt::format(
            "take: {:.1f} s of sound, {} samples left out since they came faster than they could "
            "be written\n",
            take.sound_s, take.sound_dropped);
    if (!take.failure.empty()) text += fmt::format("take: {}\n", take.failure);
    return text;
}

nlohmann::ordered_json sound_json(const SoundState& sound) {
    return {{"name", sound.name},
            {"state", key_of(sound.phase)},
            {"failure", sound.failure},
            {"failures", sound.failures},
            {"delay_ms", sound.delay_ms},
            {"peak_dbfs", sound.peak_dbfs},
            {"heard_samples", sound.heard},
            {"lost_samples", sound.lost},
            {"dropped_samples", sound.dropped},
            {"inserted_samples", sound.inserted},
            {"removed_samples", sound.removed},
            {"drift_ppm", sound.drift_ppm},
            {"played_samples", sound.played},
            {"missing_samples", sound.missing},
            {"slid_samples", sound.slid},
            {"jumps", sound.jumps}};
}

std::string sound_text(const SoundState& sound) {
    const auto ms = [](std::uint64_t samples) {
        return 1000 * static_cast<double>(samples) / sound_rate_hz;
    };
    std::string text = fmt::format(
        "sound: {}, {}, {:.1f} s, {:.0f} ms after it was heard; {:.0f} ms of it were not there, "
        "{:.0f} ms came too fast, {} over what could not be slid over; its clock is {:.0f} "
        "millionths ahead",
        sound.name, key_of(sound.phase), ms(sound.played) / 1000, sound.delay_ms, ms(sound.missing),
        ms(sound.dropped), counted(sound.jumps, "jump"), sound.drift_ppm);
    if (sound.failures > 0) text += fmt::format("; failed {}", times(sound.failures));
    if (!sound.failure.empty()) text += ": " + sound.failure;
    return text + '\n';
}

nlohmann::ordered_json output_json(const OutputState& output) {
    return {{"name", output.name},
            {"state", key_of(output.phase)},
            {"failure", output.failure},
            {"failures", output.failures},
            {"encoder", output.encoder},
            {"offered", output.offered},
            {"pictures", output.pictures},
            {"dropped", output.dropped},
            {"unheard", output.unheard},
            {"queued", output.queued},
            {"sound", output.has_sound},
            {"silenced", output.silenced},
            {"bytes", output.bytes},
            {"bit_rate_bps", output.bit_rate_bps},
            {"write_ms", to_json(output.write_ms)}};
}

std::string output_text(const OutputState& output) {
    std::string text = fmt::format("output: {}{}{}, {}, {:.1f} MB, {} left out because it was busy",
                                   output.name, output.encoder.empty() ? "" : " by ",
                                   output.encoder, counted(output.pictures, "picture"),
                                   static_cast<double>(output.bytes) / 1e6, output.dropped);
    if (output.unheard > 0)
        text += fmt::format(", {} while nobody took it", counted(output.unheard, "picture"));
    if (output.silenced > 0)
        text += fmt::format(", the sound of {}", counted(output.silenced, "picture"));
    if (output.failures > 0) text += fmt::format(", failed {}", times(output.failures));
    return text + '\n';
}

}  // namespace

std::vector<CounterGroup> counters_of(const RigAccount& rig) {
    const RigStatus& s = rig.status;
    const RigCounters& r = s.rig_counters;
    return {{"rig",
             "at the rig, since this host came",
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
              {"superseded", "superseded", rig.superseded},
              {"in_dropped_sets", "set dropped", s.in_dropped_sets}}}};
}

std::string state_of(const RigStatus& status) {
    if (!status.refused.empty()) return "refused: " + status.refused;
    return status.connected ? "connected" : "disconnected";
}

std::string full_state_of(const RigStatus& status) {
    if (!status.refused.empty()) return state_of(status);
    const std::string trouble = trouble_of(status);
    return trouble.empty() ? state_of(status) : state_of(status) + ": " + trouble;
}

std::string outages_of(const RigStatus& status) {
    std::string text;
    if (status.outages > 0)
        text = fmt::format("was away {}, {:.1f} s in all", times(status.outages), status.outage_s);
    if (status.restarts > 0)
        text += fmt::format("{}its daemon was started anew {}", text.empty() ? "" : "; ",
                            times(status.restarts));
    return text;
}

std::string counters_legend() {
    return "Every frame since this host came ends in one place. At the rig: missed (a pulse "
           "without "
           "a picture),\nlate (a step was still busy), published. On the way: thinned (this host "
           "asked for fewer or none),\npushed out (this host or its network was slow), sent; lost "
           "(sent, and the connection broke). At this\nhost: damaged (not readable), host busy, "
           "late (its set was closed), duplicate, unsynced (names no pulse\nof the stage), out of "
           "step (counts pulses differently from the other rigs), in sets; of those: fused (in "
           "a\npicture), superseded (a newer set came before a picture was due), set "
           "dropped\n(before anything took sets).\n";
}

std::vector<std::string> worries_of(const RigStatus& status) {
    std::vector<std::string> worries = computer_worries_of(status);
    if (status.connected)
        if (std::string worry = rate_worry(status); !worry.empty())
            worries.push_back(std::move(worry));
    if (status.connected && !status.same_clock && !status.sync.disciplined)
        worries.emplace_back(clocks_not_disciplined);
    if (status.connected)
        if (std::string worry = tai_worry(status); !worry.empty())
            worries.push_back(std::move(worry));
    return worries;
}

std::vector<std::string> failures_of(const LiveReport& report) {
    std::vector<std::string> failures;
    const auto add = [&](const auto& of) {
        if (!of.failure.empty())
            failures.push_back(fmt::format("{} failed after {}: {}", of.name,
                                           counted(of.pictures, "picture"), of.failure));
    };
    for (const OutputState& output : report.outputs) add(output);
    for (const SinkState& sink : report.programme.sinks) add(sink);
    return failures;
}

double pictures_a_second(const ProgrammeBooks& programme) {
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

nlohmann::ordered_json to_json(const LiveReport& report) {
    const ProgrammeBooks& programme = report.programme;
    nlohmann::ordered_json json{
        {"pictures", programme.ticks},        {"new_pictures", programme.pictures},
        {"width_px", report.format.width_px}, {"height_px", report.format.height_px},
        {"rate_hz", report.rate_hz},          {"pictures_a_second", pictures_a_second(programme)},
        {"duration_s", programme.duration_s}, {"repeated_ticks", programme.repeated},
        {"synthesiser", report.synthesiser},  {"renderer", report.renderer},
        {"signal", key_of(report.signal)}};
    json["time"] = time_json(report);
    json["interval_ms"] = to_json(programme.interval_ms);
    json["latency_ms"] = to_json(programme.latency_ms);
    json["hand_to_picture_ms"] = to_json(programme.hand_ms);
    json["seek_to_picture_ms"] = to_json(programme.seek_ms);
    json["rest_to_best_ms"] = to_json(programme.rest_ms);
    json["seek_steps_ms"] = {{"wait", to_json(programme.seek_steps_ms.wait)},
                             {"fetch", to_json(programme.seek_steps_ms.fetch)},
                             {"prepare", to_json(programme.seek_steps_ms.prepare)},
                             {"picture", to_json(programme.seek_steps_ms.picture)}};
    if (programme.preview_pictures > 0)
        json["preview"] = {{"pictures", programme.preview_pictures},
                           {"make_ms", to_json(programme.preview_ms)}};
    json["instants"] = {
        {"prepared", report.instants_prepared},
        {"between_pulses", report.instants_between},
        {"a_second", programme.duration_s > 0
                         ? static_cast<double>(report.instants_prepared) / programme.duration_s
                         : 0},
        {"skipped", report.sets_superseded}};
    json["level_shares"] = {{"render", programme.render_shares},
                            {"prepare", programme.prepare_shares}};
    json["faults"] = report.faults;
    json["contexts_lost"] = report.contexts_lost;
    if (report.sound) json["sound"] = sound_json(*report.sound);
    for (const OutputState& output : report.outputs) json["outputs"].push_back(output_json(output));
    for (const SinkState& sink : programme.sinks)
        json["outputs"].push_back(
            {{"name", sink.name}, {"pictures", sink.pictures}, {"failure", sink.failure}});
    constexpr double deg = 180 / std::numbers::pi;
    const OrbitView& view = report.view;
    json["camera"] = {{"azimuth_deg", view.azimuth_rad * deg},
                      {"elevation_deg", view.elevation_rad * deg},
                      {"distance_m", view.distance_m},
                      {"field_of_view_deg", view.field_of_view_rad * deg},
                      {"pivot_m", {view.pivot_m.x(), view.pivot_m.y(), view.pivot_m.z()}}};
    if (report.corridor.now) json["corridor"] = corridor_json(report);
    json["sets"] = {{"closed", report.sets_closed},
                    {"complete", report.sets_complete},
                    {"partial", report.sets_closed - report.sets_complete},
                    {"fused", report.instants_prepared},
                    {"superseded", report.sets_superseded},
                    {"dropped", report.sets_dropped}};
    json["rigs"] = nlohmann::ordered_json::array();
    for (const RigAccount& rig : report.rigs) {
        nlohmann::ordered_json entry{{"name", rig.status.rig}, {"state", state_of(rig.status)}};
        if (const std::string trouble = trouble_of(rig.status); !trouble.empty())
            entry["trouble"] = trouble;
        entry["outages"] = {{"count", rig.status.outages},
                            {"total_s", rig.status.outage_s},
                            {"restarts", rig.status.restarts}};
        for (const CounterGroup& group : counters_of(rig))
            for (const Counter& counter : group.counters)
                entry[group.key][counter.key] = counter.value;
        if (rig.harmony) {
            const Eigen::Vector3d gain = rig.harmony->gain();
            entry["colour"] = {{"gains", {gain[0], gain[1], gain[2]}},
                               {"shared_points", rig.harmony->samples}};
        }
        if (rig.set) {
            entry["set"] = {{"known", rig.set->known}, {"loaded", rig.set->is_loaded}};
            if (!rig.set->misfit.empty()) entry["set"]["misfit"] = rig.set->misfit;
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
    for (const StepTime& step : step_times(report)) json["stages_ms"][step.name] = to_json(step.ms);
    if (report.stereoscopy) json["stereoscopic"] = to_json(*report.stereoscopy);
    if (report.novelty) json["novelty"] = to_json(*report.novelty);
    for (const DeckDevice& wheel : report.wheels)
        json["wheels"].push_back({{"name", wheel.model},
                                  {"path", wheel.place.path},
                                  {"usable", wheel.usable},
                                  {"fault", wheel.fault},
                                  {"reports", wheel.reports},
                                  {"unread", wheel.unread}});
    for (const PortState& port : report.ports)
        json["control"].push_back({{"name", port.name},
                                   {"obeyed", port.books.obeyed},
                                   {"unknown", port.books.unknown},
                                   {"malformed", port.books.malformed},
                                   {"dropped", port.books.dropped},
                                   {"last_refusal", port.books.last_refusal},
                                   {"told", port.books.told},
                                   {"failure", port.failure}});
    if (report.take) json["take"] = take_json(*report.take);
    if (!report.saved_set.empty()) json["saved_set"] = report.saved_set;
    for (const OutputState& output : report.outputs)
        if (!output.film.empty() && !json.contains("film"))
            json["film"] = {
                {"path", output.film}, {"pictures", output.pictures}, {"dropped", output.dropped}};
    return json;
}

namespace {

std::string shares_text(const std::vector<double>& shares) {
    std::string text;
    for (std::size_t level = 0; level < shares.size(); ++level)
        if (shares[level] > 0.005)
            text +=
                fmt::format("{}{} {:.0f} %", text.empty() ? "" : ", ", level, 100 * shares[level]);
    return text.empty() ? "none" : text;
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
        text += fmt::format("faults of the GPU's work, after which it was set up anew: {}\n",
                            report.faults);
    if (report.contexts_lost > 0)
        text += fmt::format("resets of the GPU, after which all of it was set up anew: {}\n",
                            report.contexts_lost);
    for (const std::string& failure : failures_of(report)) text += failure + '\n';
    if (report.stereoscopy)
        text +=
            fmt::format("{}: eyes {:.1f} mm apart, converging at {:.2f} m\n",
                        to_json(*report.stereoscopy)["layout"].get<std::string>(),
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
    for (const PortState& port : report.ports)
        text += fmt::format(
            "control: {}, {} obeyed, {} unknown, {} malformed, {} more than may come{}{}\n",
            port.name, counted(port.books.obeyed, "message"), port.books.unknown,
            port.books.malformed, port.books.dropped,
            port.failure.empty() ? "" : "; failed: ", port.failure);
    for (const PortState& port : report.ports)
        if (!port.books.told.empty())
            text += fmt::format("control: {}: {}\n", port.name, port.books.told);
    if (report.take) text += take_text(*report.take);
    if (!report.saved_set.empty()) text += fmt::format("set saved to {}\n", report.saved_set);
    if (report.sound) text += sound_text(*report.sound);
    for (const OutputState& output : report.outputs) text += output_text(output);
    return text;
}

}  // namespace

std::string to_text(const LiveReport& report) {
    const ProgrammeBooks& programme = report.programme;
    std::string text = fmt::format(
        "\n{:g} pictures a second asked, {:.1f} new ones held: {} of {}x{} in {:.1f} s, {} of {} "
        "ticks repeated the last one (synthesiser {}, on {})\n",
        report.rate_hz, pictures_a_second(programme), programme.pictures, report.format.width_px,
        report.format.height_px, programme.duration_s, programme.repeated, programme.ticks,
        report.synthesiser, report.renderer);
    text += line_of("between two pictures", programme.interval_ms);
    if (programme.latency_ms.count > 0)
        text += line_of("exposure to picture", programme.latency_ms);
    if (programme.hand_ms.count > 0) text += line_of("hand to picture", programme.hand_ms);
    if (programme.rest_ms.count > 0)
        text += line_of("held until the best picture", programme.rest_ms);
    if (programme.seek_ms.count > 0) {
        text += line_of("seek to picture", programme.seek_ms);
        text += line_of("  waiting for the instant before", programme.seek_steps_ms.wait);
        text += line_of("  reading and decoding", programme.seek_steps_ms.fetch);
        text += line_of("  preparing", programme.seek_steps_ms.prepare);
        text += line_of("  rendering, until its tick", programme.seek_steps_ms.picture);
    }
    if (programme.preview_pictures > 0)
        text += line_of(
            fmt::format("{} of the preview, each", counted(programme.preview_pictures, "picture"))
                .c_str(),
            programme.preview_ms);
    text +=
        fmt::format("levels of quality (0 is the best) by time: rendering {}; preparing {}\n",
                    shares_text(programme.render_shares), shares_text(programme.prepare_shares));
    if (!report.played.empty()) {
        text += fmt::format(
            "{} was played: {} instants, {} more between pulses, the last of pulse {}\n",
            report.played, report.instants_prepared, report.instants_between, report.shown_pulse);
        text += corridor_text(report) + steps_text(report) + results_text(report);
        return text;
    }
    text += fmt::format(
        "{} frame sets, {} complete and {} partial: {} prepared as instants, {} superseded by a "
        "newer one, {} dropped\n",
        report.sets_closed, report.sets_complete, report.sets_closed - report.sets_complete,
        report.instants_prepared, report.sets_superseded, report.sets_dropped);
    text += corridor_text(report) + '\n' + rig_tables(report);
    if (!report.rigs.empty()) text += counters_legend() + '\n';
    text += fmt::format("signal at the end: {}\n", title_of(report.signal));
    text += rig_remarks(report);
    return text + steps_text(report) + results_text(report);
}

}  // namespace vantage
