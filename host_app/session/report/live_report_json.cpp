#include <numbers>

#include "common/wire/status_report.h"
#include "host_app/session/report/live_report.h"

namespace vantage {
namespace {

nlohmann::ordered_json corridor_json(const LiveReport& report) {
    const CorridorStats& stats = report.corridor;
    nlohmann::ordered_json json{
        {"coverage", stats.now->share},     {"place", key_of(Corridor::place_of(stats.now->share))},
        {"loss", key_of(stats.now->loss)},  {"least_coverage", stats.least_share},
        {"edge_s", stats.edge_s},           {"beyond_s", stats.beyond_s},
        {"free_flight", report.free_flight}};
    json["move_beyond"] = nlohmann::ordered_json::array();
    for (const UncoveredPart& part : report.uncovered)
        json["move_beyond"].push_back({{"from_s", part.from_s},
                                       {"to_s", part.to_s},
                                       {"least_coverage", part.least.share},
                                       {"loss", key_of(part.least.loss)}});
    return json;
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
            {"frame_sets", report.past->sets},
            {"sets", report.past->sets},  // old name
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
    nlohmann::ordered_json json{
        {"path", take.path},           {"takes", take.takes},
        {"state", key_of(take.phase)}, {"failure", take.failure},
        {"trouble", take.trouble},     {"frames", take.frames},
        {"gaps", take.gaps},           {"bytes", take.bytes},
        {"mb_s", take.mb_s},           {"duration_s", take.duration_s},
        {"disk_mb_s", take.disk_mb_s}, {"longest_unwritten_ms", take.longest_unwritten_ms}};
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

/// Adds the values of renamed keys under their old names, which are deprecated and go with the next
/// release.
void add_old_keys(nlohmann::ordered_json& json) {
    constexpr std::pair<const char*, const char*> keys[] = {
        {"new_frames_per_second", "pictures_a_second"},
        {"replaced_pictures", "superseded_pictures"},   // old name
        {"input_to_picture_ms", "hand_to_picture_ms"},  // old name
        {"idle_to_best_ms", "rest_to_best_ms"},
        {"frame_sets", "sets"},
        {"source_map", "novelty"},  // old name
        {"saved_background", "saved_set"}};
    for (const auto& [key, old_key] : keys)
        if (const auto found = json.find(key); found != json.end()) {
            nlohmann::ordered_json value = *found;
            json[old_key] = std::move(value);
        }
    const nlohmann::ordered_json replaced = json["frame_sets"]["replaced"];
    json["sets"]["superseded"] = replaced;  // old name
    const nlohmann::ordered_json per_second = json["instants"]["per_second"];
    json["instants"]["a_second"] = per_second;
}

}  // namespace

nlohmann::ordered_json to_json(const LiveReport& report) {
    const ProgrammeStats& programme = report.programme;
    nlohmann::ordered_json json{{"pictures", programme.ticks},
                                {"new_pictures", programme.pictures},
                                {"width_px", report.format.width_px},
                                {"height_px", report.format.height_px},
                                {"rate_hz", report.rate_hz},
                                {"new_frames_per_second", new_frames_per_second(programme)},
                                {"duration_s", programme.duration_s},
                                {"reprojected_ticks", programme.reprojected},
                                {"repeated_ticks", programme.repeated},
                                {"missed_ticks", programme.missed},
                                {"replaced_pictures", programme.replaced},  // old name
                                {"synthesiser", report.synthesiser},
                                {"renderer", report.renderer},
                                {"signal", key_of(report.signal)}};
    json["time"] = time_json(report);
    json["reprojected_way"] = to_json(programme.reprojected_way);
    json["tick_late_ms"] = to_json(programme.late_ms);
    json["interval_ms"] = to_json(programme.interval_ms);
    json["latency_ms"] = to_json(programme.latency_ms);
    json["input_to_picture_ms"] = to_json(programme.input_ms);
    json["seek_to_picture_ms"] = to_json(programme.seek_ms);
    json["idle_to_best_ms"] = to_json(programme.rest_ms);
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
        {"per_second", programme.duration_s > 0
                           ? static_cast<double>(report.instants_prepared) / programme.duration_s
                           : 0},
        {"skipped", report.frame_sets_replaced}};
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
    json["frame_sets"] = {{"closed", report.frame_sets_closed},
                          {"complete", report.frame_sets_complete},
                          {"partial", report.frame_sets_closed - report.frame_sets_complete},
                          {"fused", report.instants_prepared},
                          {"replaced", report.frame_sets_replaced},
                          {"dropped", report.frame_sets_dropped}};
    json["rigs"] = nlohmann::ordered_json::array();
    for (const RigAccount& rig : report.rigs) {
        nlohmann::ordered_json entry{{"name", rig.status.rig}, {"state", state_of(rig.status)}};
        if (const std::string trouble = trouble_of(rig.status); !trouble.empty())
            entry["trouble"] = trouble;
        entry["outages"] = {{"count", rig.status.outages},
                            {"total_s", rig.status.outage_s},
                            {"restarts", rig.status.restarts}};
        for (const CounterGroup& group : counters_of(rig))
            for (const Counter& counter : group.counters) {
                entry[group.key][counter.key] = counter.value;
                if (counter.old_key) entry[group.key][counter.old_key] = counter.value;
            }
        if (rig.gain_compensation) {
            const Eigen::Vector3d gain = rig.gain_compensation->gain();
            entry["colour"] = {{"gains", {gain[0], gain[1], gain[2]}},
                               {"shared_points", rig.gain_compensation->samples}};
        }
        if (rig.background) {
            nlohmann::ordered_json background{{"known", rig.background->known},
                                              {"loaded", rig.background->is_loaded}};
            if (!rig.background->misfit.empty()) background["misfit"] = rig.background->misfit;
            entry["background"] = background;
            entry["set"] = background;  // old name
        }
        entry["latency_ms"] = to_json(rig.status.latency_ms);
        entry["clock"] = clock_text(rig.status);
        entry["same_clock"] = rig.status.same_clock;
        entry["sync"] = to_json(rig.status.sync);
        entry["health"] = to_json(rig.status.health);
        entry["road"] = rig.status.by_datagrams ? "srt" : "tcp";
        if (!rig.status.datagram_trouble.empty())
            entry["road_trouble"] = rig.status.datagram_trouble;
        if (!rig.status.last_error.empty()) entry["last_error"] = rig.status.last_error;
        json["rigs"].push_back(std::move(entry));
    }
    json["stages_ms"] = nlohmann::ordered_json::object();
    for (const StepTime& step : step_times(report)) json["stages_ms"][step.name] = to_json(step.ms);
    if (report.stereoscopy) json["stereoscopic"] = to_json(*report.stereoscopy);
    if (report.source_map) json["source_map"] = to_json(*report.source_map);
    for (const DeckDevice& wheel : report.wheels)
        json["wheels"].push_back({{"name", wheel.model},
                                  {"path", wheel.place.path},
                                  {"usable", wheel.usable},
                                  {"fault", wheel.fault},
                                  {"reports", wheel.reports},
                                  {"unread", wheel.unread}});
    for (const PortState& port : report.ports)
        json["control"].push_back({{"name", port.name},
                                   {"obeyed", port.stats.obeyed},
                                   {"unknown", port.stats.unknown},
                                   {"malformed", port.stats.malformed},
                                   {"dropped", port.stats.dropped},
                                   {"last_refusal", port.stats.last_refusal},
                                   {"told", port.stats.told},
                                   {"failure", port.failure}});
    if (report.reloads.done + report.reloads.refused > 0)
        json["stage_reloads"] = {{"done", report.reloads.done},
                                 {"refused", report.reloads.refused},
                                 {"last", report.reloads.sentence}};
    if (report.take) json["take"] = take_json(*report.take);
    if (!report.saved_background.empty()) json["saved_background"] = report.saved_background;
    for (const OutputState& output : report.outputs)
        if (!output.film.empty() && !json.contains("film"))
            json["film"] = {
                {"path", output.film}, {"pictures", output.pictures}, {"dropped", output.dropped}};
    add_old_keys(json);
    return json;
}

}  // namespace vantage
