#pragma once

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

// All that the operator's desk tells, as values: whoever draws it knows no rig and no programme.

enum class RigState { present, starting, late, missed, disconnected, refused };

struct DeskRig {
    std::string name;
    RigState state = RigState::disconnected;
    double absent_s = 0;    ///< so long it was in no set that was looked at
    double rate_hz = 0;     ///< frames received a second
    double latency_ms = 0;  ///< exposure to decoded, median
    /// Frames that met no set, by the place where they were lost.
    std::uint64_t lost_at_rig = 0, lost_on_the_way = 0, lost_at_host = 0;
    const Texture* colour = nullptr;       ///< null: none yet
    const Texture* depth = nullptr;        ///< colour-mapped; null: none yet
    const Texture* mask = nullptr;         ///< the performers, white; null: they are not told
    double nearest_m = 0, farthest_m = 0;  ///< of the depth picture's colours; 0: not known
    std::optional<double> temperature_c = {};
    std::string clock = {};                       ///< a few words; empty: it says nothing
    std::string calibration = {};                 ///< age and residual; empty: it has none
    std::optional<double> background_known = {};  ///< share of its set; nothing: none is learnt
    std::vector<std::string> worries = {};        ///< what a technician should look after
};

/// A step of a frame's way, median.
struct DeskStep {
    std::string name;
    double ms = 0;
    bool at_rig = false;
};

/// Something that the programme counted or measured since its start.
struct DeskFigure {
    std::string name, value;
};

/// What the source map's colours say.
struct DeskSources {
    struct Row {
        std::string rig;
        std::array<unsigned char, 3> rgb{};
        double share = 0;  ///< of the picture's pixels
    };
    std::vector<Row> rows;
    std::string remark;  ///< why there is no map; empty: there is one
};

/// The take that is recorded, or what ended it.
struct DeskTake {
    bool is_running = false;
    std::string path;
    double duration_s = 0, mb_s = 0;
    std::uint64_t left_out = 0;  ///< frames that came and are not in it
    std::string failure;
};

/// An output of the programme.
struct DeskOutput {
    std::string name, state;
    bool is_on = false, is_failed = false;
    double mbit_s = 0;
    std::uint64_t queued = 0, left_out = 0;
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

/// What there is of time: pulses of the replay buffer, or of a take, and where the programme is.
struct DeskTime {
    double oldest = 0, newest = 0;  ///< pulses
    double rate_hz = 30;            ///< of them
    bool is_of_take = false;
    std::optional<double> at;  ///< pulse; nothing: live
    double speed = 0;          ///< unless live
    std::optional<double> in, out;
    bool loops = false;
    double recorded_s = 0;               ///< of the newest, that a running take has
    std::vector<double> keyframes = {};  ///< pulses where a move that leads time has them

    /// 0..1 along the line.
    double share_of(double pulse) const;
    double pulse_at(double share) const;
};

/// The planned move.
struct DeskMove {
    double duration_s = 0;
    std::vector<double> keyframes;  ///< 0..1 of it
};

/// The stage from above.
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
    /// Of the surfaces that the rigs see; none unless they are asked for.
    struct Point {
        Eigen::Vector3f at_m;
        std::array<unsigned char, 3> rgb;
    };
    std::vector<Point> points;
    /// How much of the camera's picture would be covered if it stood elsewhere, at its elevation
    /// and with its pivot.
    struct Field {
        double azimuth_rad = 0, width_rad = 0, from_m = 0, to_m = 0;  ///< from the pivot
        CorridorPlace place = CorridorPlace::inside;
    };
    std::vector<Field> corridor;
    Eigen::Vector3d corridor_pivot_m{0, 0, 0};
    double corridor_elevation_rad = 0;
    std::vector<Eigen::Vector3d> path_m;       ///< of the camera in the last seconds, oldest first
    std::vector<Eigen::Vector3d> move_m;       ///< of the planned move
    std::vector<Eigen::Vector3d> keyframes_m;  ///< of it
};

/// A place for a shot.
struct DeskShot {
    std::string name;                  ///< empty: nothing is kept here
    const Texture* picture = nullptr;  ///< null: not seen yet
    bool is_kept = false;              ///< by somebody; else it is what a rig sees
};

/// A clip of the bin.
struct DeskClip {
    int number = 1;
    std::string name;
    double in = 0, out = 0;            ///< pulses; `out` is the first that is left out
    double duration_s = 0, speed = 1;  ///< as it was filmed, and that it is played at
    bool is_in_hand = false, is_played = false;
    std::string loss = {};             ///< what the past lacks of it; empty: nothing
    const Texture* picture = nullptr;  ///< null: not seen yet
};

/// A line of the play list.
struct DeskEntry {
    std::string name;
    double duration_s = 0, speed = 1;  ///< as it is played
    bool is_selected = false, is_playing = false, is_gone = false;
};

struct DeskReplay {
    std::vector<DeskClip> clips;
    std::vector<DeskEntry> entries;
    bool list_loops = false, fast_jog = false;
    double programme_speed = 0.5;
    int clip = 0;  ///< that is cued or played; 0: none
    std::optional<double> clip_left_s, list_left_s;
};

/// The map of a jog wheel while it is open, and how what is in hand feels.
struct DeskWheel {
    enum class Kind { turns, axis, button };
    struct Control {
        Kind kind = Kind::button;
        std::string name, does;
        bool is_held = false;
        double at = 0;  ///< of an axis -1..1; of what turns all detents so far
    };
    /// Of a control that is no button.
    struct Feel {
        double steps = 1, dead_zone = 0, curve = 1;
        bool inverted = false;
        /// What it asks for over its way from one end to the other, or from that many detents back
        /// to as many on; and where it is now. `most`: of what is asked for.
        std::vector<float> response;
        double from = -1, to = 1, most = 1, at = 0, asks = 0;
        std::string unit;  ///< of what it asks for
    };
    std::string name;  ///< of the wheel; empty: none has been plugged in
    std::string file;  ///< that the map is saved in
    std::vector<Control> controls;
    std::size_t selected = 0;
    std::optional<Feel> feel;
    bool is_changed = false;  ///< and not saved
    std::string remark;       ///< what the last change came to; empty: nothing to say

    // What hands are about to change of it, which the window adds (see WheelPanel).
    struct Choice {
        std::string action, does;
    };
    bool is_choosing = false;      ///< what the control in hand is to do
    std::string typed;             ///< how its name begins
    std::vector<Choice> choices;   ///< that are left
    std::size_t chosen = 0;        ///< of them
    std::size_t feel_in_hand = 0;  ///< of steps, dead zone, curve, inverted
};

/// The camera on preview, which hands fly.
struct DeskPreview {
    const Texture* picture = nullptr;  ///< null: not seen yet
    OrbitView view;
    double picture_rate_hz = 0;
    bool is_near_only = false;  ///< what it shows is prepared for where the programme's camera is
    std::optional<Coverage> coverage;
    std::optional<double> fly_progress;    ///< 0..1 while the programme's camera flies to its view
    std::optional<double> programme_move;  ///< 0..1 while that is on the planned move
    double fly_s = 1.5;                    ///< that such a flight takes
};

struct DeskState {
    const Texture* picture = nullptr;  ///< the virtual view
    std::string timecode;
    std::string ltc;  ///< that comes in, and by how much it differs; empty: none
    std::uint64_t pulse = 0;
    bool is_ltc_off = false;
    bool waiting = true;          ///< no instant is ready yet
    bool has_frame_sets = false;  ///< of frames, whether ready or not
    SignalState signal = SignalState::live;
    bool recording = false;  ///< a film
    bool recording_flight = false;
    std::optional<DeskTake> take;    ///< nothing: no take is recorded
    std::optional<DeskSound> sound;  ///< nothing: there is none
    std::vector<DeskOutput> outputs;
    std::vector<int> programme_monitors;                  ///< that it fills, counted from 1
    bool programme_tally = false, preview_tally = false;  ///< as the vision mixer says
    std::string question;            ///< that a second press of a key answers; empty: none
    std::optional<double> behind_s;  ///< while in a stage's past: how far
    std::string typed;               ///< the line in which a command is typed; empty: none
    std::string notice;              ///< what replay could not do a moment ago; empty: nothing
    DeskReplay replay;
    std::optional<DeskTime> time;     ///< nothing: there is no past
    double picture_rate_hz = 0;       ///< of new ones
    double tick_rate_hz = 0;          ///< of the programme
    double repeat_rate_hz = 0;        ///< of ticks that had to repeat a picture
    std::uint64_t repeated = 0;       ///< such ticks so far
    double latency_ms = 0;            ///< from exposure to this window; 0: not known
    std::optional<double> age_s;      ///< of what is shown, while it is live
    std::vector<float> latencies_ms;  ///< oldest first
    std::string synthesiser, renderer;
    int render_level = 0, prepare_level = 0;  ///< of the picture's quality; 0 is the best
    std::vector<DeskStep> steps;
    std::vector<DeskFigure> figures;
    std::vector<DeskRig> rigs;
    std::string synchronisation;  ///< what light last said of it; empty: of no stage
    OrbitView view;               ///< of the programme's camera
    bool is_sync_doubtful = false;
    bool follows_performer = false, holds_horizon = true;
    std::optional<DeskPlan> plan;         ///< nothing: the stage is not known yet
    std::optional<Coverage> coverage;     ///< of the view by the rigs; nothing: not known
    std::optional<DeskMove> move;         ///< nothing: none is planned
    std::optional<double> move_progress;  ///< 0..1 while the camera in hand is on the move
    std::string wheel;                    ///< what the jog wheel does; empty: there is none
    std::optional<DeskWheel> wheel_map;   ///< nothing: it is not open
    bool has_unsaved_wheel = false;       ///< a map was changed and not saved
    std::optional<DeskSources> sources;   ///< while the source map is asked for
    std::vector<DeskShot> shots;          ///< 1 and on
    std::optional<DeskPreview> preview;   ///< nothing: hands fly the programme's camera

    bool is_of_take() const { return time && time->is_of_take; }
};

}  // namespace vantage
