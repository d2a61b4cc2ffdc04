#include "common/config/stage_change.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace vantage {
namespace {

const StageConfig::Rig* find_rig(const StageConfig& stage, const std::string& name) {
    for (const StageConfig::Rig& rig : stage.rigs)
        if (rig.name == name) return &rig;
    return nullptr;
}

/// The names of the rigs of `stage` that `other` has too, in the order of `stage`.
std::vector<std::string> common_rigs(const StageConfig& stage, const StageConfig& other) {
    std::vector<std::string> names;
    for (const StageConfig::Rig& rig : stage.rigs)
        if (find_rig(other, rig.name)) names.push_back(rig.name);
    return names;
}

std::vector<std::string> changed_start_keys(const StageConfig& a, const StageConfig& b) {
    std::vector<std::string> keys;
    const auto compare = [&](const char* key, const auto& before, const auto& after) {
        if (before != after) keys.emplace_back(key);
    };
    compare("rate_hz", a.rate_hz, b.rate_hz);
    compare("timecode.zone", a.timecode_zone, b.timecode_zone);
    const StageConfig::View &view = a.view, &other_view = b.view;
    compare("view.width_px", view.width_px, other_view.width_px);
    compare("view.height_px", view.height_px, other_view.height_px);
    compare("view.field_of_view_deg", view.field_of_view_deg, other_view.field_of_view_deg);
    if (!std::equal(view.target_m, view.target_m + 3, other_view.target_m))
        keys.emplace_back("view.target_m");
    compare("view.distance_m", view.distance_m, other_view.distance_m);
    compare("view.azimuth_deg", view.azimuth_deg, other_view.azimuth_deg);
    compare("view.elevation_deg", view.elevation_deg, other_view.elevation_deg);
    compare("view.synthesiser", view.synthesiser, other_view.synthesiser);
    const StageConfig::Flight &flight = a.flight, &other_flight = b.flight;
    compare("flight.horizon", flight.holds_horizon, other_flight.holds_horizon);
    compare("flight.smoothing_s", flight.smoothing_s, other_flight.smoothing_s);
    compare("flight.ramp_s", flight.ramp_s, other_flight.ramp_s);
    compare("flight.max_turn_deg_s", flight.max_turn_deg_s, other_flight.max_turn_deg_s);
    compare("flight.max_zoom_deg_s", flight.max_zoom_deg_s, other_flight.max_zoom_deg_s);
    compare("flight.max_speed_m_s", flight.max_speed_m_s, other_flight.max_speed_m_s);
    compare("flight.shot_s", flight.shot_s, other_flight.shot_s);
    compare("flight.keyframe_s", flight.keyframe_s, other_flight.keyframe_s);
    return keys;
}

}  // namespace

StageChange stage_change(const StageConfig& running, const StageConfig& file) {
    StageChange change;
    for (const StageConfig::Rig& rig : running.rigs)
        if (!find_rig(file, rig.name)) change.removed.push_back(rig.name);
    for (const StageConfig::Rig& rig : file.rigs) {
        const StageConfig::Rig* before = find_rig(running, rig.name);
        if (!before) {
            change.added.push_back(rig.name);
            continue;
        }
        if (before->endpoint != rig.endpoint) change.moved.push_back(rig.name);
        if (before->public_key != rig.public_key) change.rekeyed.push_back(rig.name);
        if (before->colour != rig.colour) change.recoloured.push_back(rig.name);
    }
    change.has_new_order = common_rigs(running, file) != common_rigs(file, running);
    change.has_new_latency_budget = running.latency_budget_ms != file.latency_budget_ms;
    change.left = changed_start_keys(running, file);
    return change;
}

StageConfig stage_to_go_on_with(const StageConfig& running, const StageConfig& file) {
    StageConfig stage = file;
    stage.rate_hz = running.rate_hz;
    stage.timecode_zone = running.timecode_zone;
    stage.view = running.view;
    stage.flight = running.flight;
    return stage;
}

std::string text_of(const StageChange& change, bool has_new_host_key) {
    std::vector<std::string> parts;
    const auto add = [&](const char* what, const std::vector<std::string>& names) {
        if (!names.empty())
            parts.push_back(fmt::format("{} {} {}", what, names.size() > 1 ? "rigs" : "rig",
                                        fmt::join(names, ", ")));
    };
    add("added", change.added);
    add("removed", change.removed);
    add("another endpoint for", change.moved);
    add("another public key for", change.rekeyed);
    add("another colour file for", change.recoloured);
    if (has_new_host_key) parts.emplace_back("another key of this host");
    if (change.has_new_latency_budget) parts.emplace_back("another latency budget");
    if (change.has_new_order) parts.emplace_back("another order of the rigs");
    std::string text = parts.empty() ? std::string("nothing that a running show can follow changed")
                                     : fmt::format("{}", fmt::join(parts, "; "));
    if (!change.left.empty())
        text += fmt::format("; not applied until the next start: {}", fmt::join(change.left, ", "));
    return text;
}

}  // namespace vantage
