#include "host_app/takes/take_show.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/base/error.h"
#include "common/base/log.h"
#include "common/colour/colour_file.h"

namespace vantage {
namespace {

double within(const nlohmann::ordered_json& json, const char* key, double least, double most) {
    const double value = json.at(key).get<double>();
    if (!std::isfinite(value) || value < least || value > most)
        fail("its take.json has {} = {}, outside {}..{}", key, value, least, most);
    return value;
}

}  // namespace

TakeShow take_show_of(const StageConfig& stage) {
    TakeShow show{stage.timecode_zone, stage.view, {}};
    for (const StageConfig::Rig& rig : stage.rigs)
        if (!rig.colour.empty()) show.colours[rig.name] = load_colour(rig.colour);
    return show;
}

nlohmann::ordered_json to_json(const TakeShow& show) {
    const StageConfig::View& view = show.view;
    nlohmann::ordered_json json{
        {"timecode_zone", show.timecode_zone},
        {"view",
         {{"width_px", view.width_px},
          {"height_px", view.height_px},
          {"field_of_view_deg", view.field_of_view_deg},
          {"target_m", {view.target_m[0], view.target_m[1], view.target_m[2]}},
          {"distance_m", view.distance_m},
          {"azimuth_deg", view.azimuth_deg},
          {"elevation_deg", view.elevation_deg},
          {"is_placed", view.is_placed},
          {"synthesiser", view.synthesiser}}}};
    json["colours"] = nlohmann::ordered_json::object();
    for (const auto& [rig, colour] : show.colours) {
        nlohmann::ordered_json entry;
        for (int row = 0; row < 3; ++row)
            for (int column = 0; column < 3; ++column)
                entry["matrix"].push_back(colour.matrix(row, column));
        for (int i = 0; i < 3; ++i) entry["tone"].push_back(colour.tone[i]);
        json["colours"][rig] = entry;
    }
    return json;
}

TakeShow take_show_from(const nlohmann::ordered_json& json) {
    // A rig's own recording has no show.
    if (!json.contains("view")) return {};
    try {
        TakeShow show;
        show.timecode_zone = json.at("timecode_zone").get<std::string>();
        const nlohmann::ordered_json& view = json.at("view");
        constexpr double least_px = 16, most_px = 4096;
        show.view.width_px = static_cast<int>(within(view, "width_px", least_px, most_px));
        show.view.height_px = static_cast<int>(within(view, "height_px", least_px, most_px));
        show.view.field_of_view_deg = within(view, "field_of_view_deg", 1, 150);
        for (std::size_t i = 0; i < 3; ++i)
            show.view.target_m[i] = view.at("target_m").at(i).get<double>();
        show.view.distance_m = within(view, "distance_m", 0.05, 1000);
        show.view.azimuth_deg = within(view, "azimuth_deg", -360, 360);
        show.view.elevation_deg = within(view, "elevation_deg", -89, 89);
        show.view.is_placed = view.at("is_placed").get<bool>();
        show.view.synthesiser = view.at("synthesiser").get<std::string>();
        for (const auto& [rig, entry] : json.at("colours").items()) {
            ColourCorrection colour;
            for (std::size_t i = 0; i < 9; ++i)
                colour.matrix(static_cast<int>(i / 3), static_cast<int>(i % 3)) =
                    entry.at("matrix").at(i).get<double>();
            for (std::size_t i = 0; i < 3; ++i)
                colour.tone[static_cast<int>(i)] = entry.at("tone").at(i).get<double>();
            colour.validate();
            show.colours[rig] = colour;
        }
        return show;
    } catch (const nlohmann::json::exception&) {
        fail("its take.json has no valid description of the show");
    }
}

FlightHabits habits_of(const StageConfig::Flight& flight) {
    constexpr double rad = std::numbers::pi / 180;
    FlightHabits habits;
    habits.holds_horizon = flight.holds_horizon;
    habits.shot_s = flight.shot_s;
    habits.keyframe_gap_s = flight.keyframe_s;
    habits.max_turn_rad_s = rad * flight.max_turn_deg_s;
    habits.max_zoom_rad_s = rad * flight.max_zoom_deg_s;
    habits.max_speed_m_s = flight.max_speed_m_s;
    habits.ramp_s = flight.ramp_s;
    habits.follow_s = flight.smoothing_s;
    return habits;
}

FlightHabits habits_of(const TakeReader& take) {
    const std::vector<TakeAttachment>& attachments = take.facts().attachments;
    const auto stage = std::find_if(
        attachments.begin(), attachments.end(),
        [](const TakeAttachment& attachment) { return attachment.name == stage_attachment; });
    if (stage == attachments.end()) return {};
    try {
        return habits_of(stage_flight_from(
            {reinterpret_cast<const char*>(stage->bytes.data()), stage->bytes.size()},
            take.path() / stage_attachment));
    } catch (const Error& error) {
        log_warning("using the default flight settings instead of the take's: {}", error.what());
        return {};
    }
}

}  // namespace vantage
