#include "common/config/stage_config.h"

#include <algorithm>
#include <sstream>

#include <fmt/format.h>

#include "common/base/files/atomic_file.h"
#include "common/base/time/time_zone.h"
#include "common/config/stream_keys.h"
#include "common/config/toml_reader.h"

namespace vantage {
namespace {

constexpr int stage_config_version = 1;

/// The first word of a file that `vantage-rig keys show` has written.
std::string read_public_key(const TomlTable& table, const std::filesystem::path& path) {
    constexpr std::size_t max_bytes = 4096;
    const std::vector<std::byte> bytes = read_file(path, max_bytes);
    std::istringstream text(std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
    std::string key;
    if (!(text >> key)) table.refuse("public_key_file", fmt::format("is empty: {}", path.string()));
    return key;
}

void read_rig(TomlTable& table, std::vector<StageConfig::Rig>& rigs) {
    StageConfig::Rig rig;
    read_stream_name(table, rig.name);
    const auto same_name = [&](const StageConfig::Rig& other) { return other.name == rig.name; };
    if (std::any_of(rigs.begin(), rigs.end(), same_name))
        table.refuse("name",
                     fmt::format("is '{}' a second time: every rig needs its own name", rig.name));
    table.require("endpoint");
    table.read("endpoint", rig.endpoint);
    if (table.has("endpoint")) check_endpoint(table, "endpoint", rig.endpoint);
    table.read("public_key", rig.public_key);
    std::filesystem::path public_key_file;
    table.read("public_key_file", public_key_file);
    if (!public_key_file.empty()) {
        if (!rig.public_key.empty())
            table.refuse("public_key_file", "and 'public_key' exclude each other: keep one");
        rig.public_key = read_public_key(table, public_key_file);
    }
    table.read("colour", rig.colour);
    rigs.push_back(std::move(rig));
}

void read_timecode(TomlTable& table, StageConfig& config) {
    table.read("zone", config.timecode_zone);
    if (!config.timecode_zone.empty() && !is_time_zone(config.timecode_zone))
        table.refuse("zone", fmt::format("= '{}' is not a time zone of this computer; timedatectl "
                                         "list-timezones lists them",
                                         config.timecode_zone));
}

void read_view(TomlTable& table, StageConfig::View& view) {
    table.read("width_px", view.width_px, {16, 4096});
    table.read("height_px", view.height_px, {16, 4096});
    table.read("field_of_view_deg", view.field_of_view_deg, {1, 150});
    table.read("target_m", view.target_m);
    table.read("distance_m", view.distance_m, {0.05, 1000});
    table.read("azimuth_deg", view.azimuth_deg, {-360, 360});
    table.read("elevation_deg", view.elevation_deg, {-89, 89});
    for (const char* key : {"target_m", "distance_m", "azimuth_deg", "elevation_deg"})
        view.is_placed = view.is_placed || table.has(key);
    table.read("synthesiser", view.synthesiser);
}

void read_flight(TomlTable& table, StageConfig::Flight& flight) {
    table.read("horizon", flight.holds_horizon);
    table.read("smoothing_s", flight.smoothing_s, {0.01, 5});
    table.read("ramp_s", flight.ramp_s, {0, 10});
    table.read("max_turn_deg_s", flight.max_turn_deg_s, {1, 720});
    table.read("max_zoom_deg_s", flight.max_zoom_deg_s, {1, 360});
    double max_speed_m_s = 0;
    table.read("max_speed_m_s", max_speed_m_s, {0.01, 100});
    if (table.has("max_speed_m_s")) flight.max_speed_m_s = max_speed_m_s;
    table.read("shot_s", flight.shot_s, {0, 60});
    table.read("keyframe_s", flight.keyframe_s, {0.1, 600});
}

}  // namespace

StageConfig load_stage_config(const std::filesystem::path& path) {
    StageConfig config;
    read_toml_file(path, stage_config_version, [&](TomlTable& top) {
        if (top.has("cameras") && !top.has("rigs"))
            top.refuse("cameras",
                       "are single cameras, and a show needs rigs: let vantage-calib stage --pairs "
                       "auto form rigs of them, or render their outlines with vantage render "
                       "--views STAGE.toml");
        // Entries for vantage-calib and vantage render, see stage_cameras.h.
        top.read_tables("cameras", [](TomlTable& camera) { camera.leave_others(); });
        top.require("rigs");
        top.read_tables("rigs", [&](TomlTable& t) { read_rig(t, config.rigs); });
        if (top.has("rigs") && config.rigs.empty())
            top.refuse("rigs", "is empty: a stage needs at least one rig");
        top.read("key_file", config.key_file);
        top.read("rate_hz", config.rate_hz, {0.01, 1000});
        top.read("latency_budget_ms", config.latency_budget_ms, {1, 60000});
        top.read_table("timecode", [&](TomlTable& t) { read_timecode(t, config); });
        top.read_table("view", [&](TomlTable& t) { read_view(t, config.view); });
        top.read_table("flight", [&](TomlTable& t) { read_flight(t, config.flight); });
    });
    return config;
}

StageConfig::Flight stage_flight_from(std::string_view text, const std::filesystem::path& name) {
    StageConfig::Flight flight;
    read_toml_text(text, name, stage_config_version, [&](TomlTable& top) {
        top.leave_others();
        top.read_table("flight", [&](TomlTable& t) { read_flight(t, flight); });
    });
    return flight;
}

}  // namespace vantage
