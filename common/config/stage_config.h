#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace vantage {

/// What the host is told (stage.toml; documented key by key in hw_config/stage.toml).
struct StageConfig {
    struct Rig {
        std::string name;
        std::string endpoint;  ///< tcp://host:port of the rig's publisher
        /// The rig's CURVE public key, Z85, from public_key or public_key_file; needed beyond
        /// loopback.
        std::string public_key;
        std::filesystem::path colour{};  ///< its colour correction; empty: none
    };
    std::vector<Rig> rigs;
    std::filesystem::path key_file;  ///< this host's CURVE key pair

    double rate_hz = 30;  ///< of the stage's clock
    double latency_budget_ms =
        200;  ///< a rig whose frame of pulse k is later than this is left out of set k

    std::string timecode_zone;  ///< whose time of day is shown; empty: this computer's

    struct View {
        int width_px = 1280, height_px = 720;
        double field_of_view_deg = 45;     ///< horizontal
        double target_m[3] = {0, 1.0, 0};  ///< pivot of the orbit, world
        double distance_m = 4.5;
        double azimuth_deg = 0, elevation_deg = 10;
        bool is_placed = false;  ///< any of the four that place it is given
        std::string synthesiser = "fused";
    } view;

    /// How hands fly.
    struct Flight {
        bool holds_horizon = true;
        double smoothing_s = 0.12, ramp_s = 0.1;
        double max_turn_deg_s = 120, max_zoom_deg_s = 57;
        std::optional<double> max_speed_m_s;  ///< nothing: as the stage is deep
        double shot_s = 1.5, keyframe_s = 3;
    } flight;
};

/// Throws Error with file and line for whatever does not fit.
StageConfig load_stage_config(const std::filesystem::path& path);

/// How hands fly, of a stage's file that is a text in memory: files that it names need not be at
/// hand. `name` stands for it in what is refused. Throws Error likewise.
StageConfig::Flight stage_flight_from(std::string_view text, const std::filesystem::path& name);

}  // namespace vantage
