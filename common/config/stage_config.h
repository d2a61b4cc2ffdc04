#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace vantage {

/// The configuration of the host (stage.toml). hw_config/stage.toml documents every key.
struct StageConfig {
    struct Rig {
        std::string name;
        std::string endpoint;  ///< tcp://host:port of the rig
        /// The rig's CURVE public key in Z85, from public_key or public_key_file; needed beyond
        /// loopback.
        std::string public_key;
        std::filesystem::path colour{};  ///< colour file of the rig; empty: no correction
    };
    std::vector<Rig> rigs;
    std::filesystem::path key_file;  ///< this host's CURVE key pair

    double rate_hz = 30;  ///< trigger rate
    double latency_budget_ms =
        200;  ///< a frame set closes this long after its first frame, without later rigs

    std::string timecode_zone;  ///< time zone of the time code; empty: this computer's

    struct View {
        int width_px = 1280, height_px = 720;
        double field_of_view_deg = 45;     ///< horizontal
        double target_m[3] = {0, 1.0, 0};  ///< pivot of the orbit in the world
        double distance_m = 4.5;
        double azimuth_deg = 0, elevation_deg = 10;
        bool is_placed = false;  ///< whether any of the four keys of the pose is given
        std::string synthesiser = "fused";
    } view;

    /// Limits and speeds of flying by hand.
    struct Flight {
        bool holds_horizon = true;
        double smoothing_s = 0.12, ramp_s = 0.1;
        double max_turn_deg_s = 120, max_zoom_deg_s = 57;
        std::optional<double> max_speed_m_s;  ///< empty: from the depth of the stage
        double shot_s = 1.5, keyframe_s = 3;
    } flight;
};

/// Throws Error with file and line for an invalid file.
StageConfig load_stage_config(const std::filesystem::path& path);

/// The [flight] keys of a stage file in memory, without checking the files that it names. `name`
/// stands for the file in errors. Throws Error.
StageConfig::Flight stage_flight_from(std::string_view text, const std::filesystem::path& name);

}  // namespace vantage
