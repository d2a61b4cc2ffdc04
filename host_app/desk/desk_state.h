#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "common/gl/objects/texture.h"
#include "common/receive/signal_state.h"
#include "host_app/flight/corridor.h"
#include "host_app/flight/orbit_view.h"

namespace vantage {

// Everything that the operator's desk shows, as plain values. The code that draws the desk knows
// nothing of rigs, programme or session. Textures belong to the DeskFeed and live until its next
// call; a null texture means that there is no picture yet.

enum class RigState { present, starting, late, missed, disconnected, refused };

struct DeskRig {
    std::string name;
    RigState state = RigState::disconnected;
    double absent_s = 0;    ///< time since the rig was last in a frame set
    double rate_hz = 0;     ///< frames received per second
    double latency_ms = 0;  ///< median, from exposure to decoded
    /// Frames that reached no frame set, by the place where they were lost.
    std::uint64_t lost_at_rig = 0, lost_on_the_way = 0, lost_at_host = 0;
    const Texture* colour = nullptr;
    const Texture* depth = nullptr;        ///< false colours
    const Texture* mask = nullptr;         ///< the foreground in white
    double nearest_m = 0, farthest_m = 0;  ///< range of the depth picture's colours; 0: unknown
    std::optional<double> temperature_c = {};
    std::string clock = {};                       ///< state of the rig's clock in a few words
    std::string calibration = {};                 ///< age and residual; empty: no calibration
    std::optional<double> background_known = {};  ///< learnt share of the background, 0..1
    std::vector<std::string> worries = {};        ///< faults that a technician should look at
};

/// A step of a frame's way from exposure to output: its median duration.
struct DeskStep {
    std::string name;
    double ms = 0;
    bool at_rig = false;
};

/// A count or measurement of the programme since its start.
struct DeskFigure {
    std::string name, value;
};

/// The legend of the source map.
struct DeskSources {
    struct Row {
        std::string rig;
        std::array<unsigned char, 3> rgb{};
        double share = 0;  ///< of the picture's pixels, 0..1
    };
    std::vector<Row> rows;
    std::string remark;  ///< why there is no source map; empty: there is one
};

/// The take that is recorded, or the last one that ended.
struct DeskTake {
    bool is_running = false;
    std::string path;
    double duration_s = 0, mb_s = 0;
    std::uint64_t left_out = 0;  ///< frames that were received and are not in the take
    std::string failure, trouble;
};

/// An output of the programme.
struct DeskOutput {
    std::string name, state;
    bool is_on = false, is_failed = false;
    double mbit_s = 0;
    std::uint64_t queued = 0, left_out = 0;  ///< frames
    std::string failure;
};

/// The programme's sound.
struct DeskSound {
    std::string name, state;
    bool is_on = false;
    double peak_dbfs = -120;
    std::uint64_t missing_ms = 0;
    std::string failure;
};

/// The range of time that can be shown, of the replay buffer or of a take, and the programme's
/// place in it. Times are pulses.
struct DeskTime {
    double oldest = 0, newest = 0;
    double rate_hz = 30;  ///< pulses per second
    bool is_of_take = false;
    std::optional<double> at;  ///< nothing: live
    double speed = 0;          ///< playing speed; unused while live
    std::optional<double> in, out;
    bool loops = false;
    double recorded_s = 0;               ///< length of the running take
    std::vector<double> keyframes = {};  ///< keyframes of a move that is tied to the take's time

    /// Converts a pulse to a place on the time line, 0..1.
    double share_of(double pulse) const {
        return std::clamp((pulse - oldest) / std::max(1.0, newest - oldest), 0.0, 1.0);
    }
    /// Converts a place on the time line, 0..1, to a pulse.
    double pulse_at(double share) const {
        return oldest + std::clamp(share, 0.0, 1.0) * (newest - oldest);
    }
};

/// The planned move.
struct DeskMove {
    double duration_s = 0;
    std::vector<double> keyframes;  ///< 0..1 of the duration
};

/// The stage's geometry for the plan and the 3-D view.
struct DeskPlan {
    struct Rig {
        std::string name;
        Eigen::Vector3d eye_m{0, 0, 0}, forward{0, 0, -1};
        double half_width = 0.46;  ///< of its picture, at a depth of 1
        double half_height = 0.35;
        bool is_away = false;
    };
    std::vector<Rig> rigs;
    StageExtent extent;
    /// A point of a surface that a rig sees.
    struct Point {
        Eigen::Vector3f at_m;
        std::array<unsigned char, 3> rgb;
    };
    std::vector<Point> points;  ///< empty unless the 3-D view is shown
    /// A field of the corridor around the pivot, with the coverage that a camera in its middle
    /// would have at the present elevation.
    struct Field {
        double azimuth_rad = 0, width_rad = 0, from_m = 0, to_m = 0;  ///< from the pivot
        CorridorPlace place = CorridorPlace::inside;
    };
    std::vector<Field> corridor;
    Eigen::Vector3d corridor_pivot_m{0, 0, 0};
    double corridor_elevation_rad = 0;
    std::vector<Eigen::Vector3d> path_m;  ///< the camera in the last seconds, oldest first
    std::vector<Eigen::Vector3d> move_m;  ///< the planned move
    std::vector<Eigen::Vector3d> keyframes_m;
};

/// One of the places for shots.
struct DeskShot {
    std::string name;  ///< empty: the place is free
    const Texture* picture = nullptr;
    bool is_kept = false;  ///< the operator stored it; false: the view of a rig
};

/// A clip of the bin.
struct DeskClip {
    int number = 1;
    std::string name;
    double in = 0, out = 0;            ///< pulses; `out` is the first one after the clip
    double duration_s = 0, speed = 1;  ///< recorded duration, and playing speed
    bool is_in_hand = false;           ///< commands act on it
    bool is_played = false;
    std::string loss = {};  ///< part that the replay buffer no longer has; empty: none
    const Texture* picture = nullptr;
};

/// An entry of the play list.
struct DeskEntry {
    std::string name;
    double duration_s = 0, speed = 1;  ///< as played
    bool is_selected = false, is_playing = false, is_gone = false;
};

struct DeskReplay {
    std::vector<DeskClip> clips;
    std::vector<DeskEntry> entries;
    bool list_loops = false, fast_jog = false;
    double programme_speed = 0.5;
    int clip = 0;  ///< the clip that is cued or played; 0: none
    std::optional<double> clip_left_s, list_left_s;
};

/// The map of a jog wheel while it is open, and the response of the selected control.
struct DeskWheel {
    enum class Kind { turns, axis, button };
    struct Control {
        Kind kind = Kind::button;
        std::string name, does;
        bool is_held = false;
        double at = 0;  ///< of an axis: -1..1; of a wheel: detents since the start
    };
    /// The response of a control that is not a button.
    struct Feel {
        double steps = 1, dead_zone = 0, curve = 1;
        bool inverted = false;
        /// Samples of the response from `from` to `to`: an axis from end to end, a wheel over a few
        /// detents. `most` is the response at `to`; `at` and `asks` are the present input and
        /// response.
        std::vector<float> response;
        double from = -1, to = 1, most = 1, at = 0, asks = 0;
        std::string unit;  ///< of the response
    };
    std::string name;  ///< of the wheel; empty: none was plugged in
    std::string file;  ///< that the map is saved in
    std::vector<Control> controls;
    std::size_t selected = 0;
    std::optional<Feel> feel;
    bool is_changed = false;  ///< there are changes that are not saved
    std::string remark;       ///< result of the last change; empty: none

    // Operator input that the window adds (see WheelPanel).
    struct Choice {
        std::string action, does;
    };
    bool is_choosing = false;  ///< a command is chosen for the selected control
    std::string typed;         ///< filter of the choices
    std::vector<Choice> choices;
    std::size_t chosen = 0;
    std::size_t feel_in_hand = 0;  ///< 0: steps, 1: dead zone, 2: curve, 3: inverted
};

/// The camera on preview, which operator input flies.
struct DeskPreview {
    const Texture* picture = nullptr;
    OrbitView view;
    double picture_rate_hz = 0;
    bool is_near_only = false;  ///< the instant is prepared in detail for the programme's view only
    std::optional<Coverage> coverage;
    std::optional<double> fly_progress;    ///< 0..1 while the programme's camera flies to this view
    std::optional<double> programme_move;  ///< 0..1 while the programme is on the planned move
    double fly_s = 1.5;                    ///< duration of such a flight
};

/// All values of the desk.
struct DeskState {
    const Texture* picture = nullptr;  ///< the programme
    std::string timecode;
    std::string ltc;  ///< incoming LTC and its difference; empty: none
    std::uint64_t pulse = 0;
    bool is_ltc_off = false;
    bool waiting = true;          ///< there is no instant yet
    bool has_frame_sets = false;  ///< frames were received
    SignalState signal = SignalState::live;
    bool recording = false;  ///< a film
    bool recording_flight = false;
    std::optional<DeskTake> take;
    std::optional<DeskSound> sound;
    std::vector<DeskOutput> outputs;
    std::vector<int> programme_monitors;  ///< monitors that the programme fills, counted from 1
    bool programme_tally = false, preview_tally = false;  ///< from the vision mixer
    std::string question;            ///< asks for a second key press; empty: none
    std::optional<double> behind_s;  ///< distance to live while the past is shown
    std::string typed;               ///< the command line while it is open; empty: closed
    std::string notice;              ///< why replay refused a command, or the last reload of the
                                     ///< stage file; empty: none
    DeskReplay replay;
    std::optional<DeskTime> time;     ///< nothing: there is no past to show
    double picture_rate_hz = 0;       ///< new frames per second
    double tick_rate_hz = 0;          ///< output frames per second
    double repeat_rate_hz = 0;        ///< ticks per second that repeat the last frame
    std::uint64_t repeated = 0;       ///< such ticks since the start
    double latency_ms = 0;            ///< from exposure to this window; 0: unknown
    std::optional<double> age_s;      ///< of the picture while it is live
    std::vector<float> latencies_ms;  ///< oldest first
    std::string synthesiser, renderer;
    int render_level = 0, prepare_level = 0;  ///< levels of quality; 0 is the best
    std::vector<DeskStep> steps;
    std::vector<DeskFigure> figures;
    std::vector<DeskRig> rigs;
    std::string computer_worry;   ///< what the host's computer lacks; empty: nothing
    std::string synchronisation;  ///< result of the last sync measurement; empty: of a take
    OrbitView view;               ///< of the programme's camera
    bool is_sync_doubtful = false;
    bool follows_performer = false, holds_horizon = true;
    std::optional<DeskPlan> plan;         ///< nothing: the stage is unknown
    std::optional<Coverage> coverage;     ///< of the programme's view by the rigs
    std::optional<DeskMove> move;         ///< nothing: none is planned
    std::optional<double> move_progress;  ///< 0..1 while the flown camera is on the move
    std::string wheel;                    ///< mode of the jog wheel; empty: there is none
    std::optional<DeskWheel> wheel_map;   ///< nothing: it is closed
    bool has_unsaved_wheel = false;       ///< a wheel's map has changes that are not saved
    std::optional<DeskSources> sources;   ///< nothing: the source map is off
    std::vector<DeskShot> shots;          ///< shots 1, 2, ...
    std::optional<DeskPreview> preview;   ///< nothing: operator input flies the programme

    bool is_of_take() const { return time && time->is_of_take; }
};

}  // namespace vantage
