#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "host_app/replay/replay_call.h"

namespace vantage {

/// What the operator's hands did since the last look, whatever they held. Angles in radians, shifts
/// in picture widths, dolly and zoom in powers of e (see OrbitCamera).
struct FlightInput {
    double orbit_azimuth_rad = 0, orbit_elevation_rad = 0;
    double pan_right_widths = 0, pan_up_widths = 0;
    double dolly = 0, zoom = 0;
    double crane_up_widths = 0;
    double look_right_rad = 0, look_up_rad = 0;  ///< the camera turns where it stands
    double roll_rad = 0;
    bool toggle_freeze = false, reset = false, next_synthesiser = false, toggle_move = false;
    bool toggle_tracking = false;
    bool toggle_jog_map = false;  ///< on the desk
    bool next_wheel_mode = false, to_live = false, toggle_source_map = false, toggle_take = false;
    bool save_background = false, learn_background = false;
    bool mark_in = false, mark_out = false, clear_marks = false, toggle_loop = false, cue = false;
    bool add_keyframe = false, set_keyframe = false, remove_keyframe = false;
    bool toggle_recording = false;  ///< of a flight
    bool toggle_horizon = false, toggle_follow = false;
    bool toggle_preview = false;               ///< a second camera, which hands fly then
    bool cut = false, fly_to_preview = false;  ///< to its view: at once, or in the time for that
    int fly_to_preview_tenths = 0;             ///< that time from now on; 0: as it was
    /// A place in the picture, 0..1 to the right and down: the pivot goes to what is seen there.
    std::optional<Eigen::Vector2d> pick = {};
    std::optional<Eigen::Vector3d> pivot_m = {};  ///< where that was found
    int keyframe_jump = 0;                        ///< to the next keyframes of the move, either way
    double retime_s = 0;                          ///< of the keyframe at which the move stands
    int speed_steps = 0;                          ///< to faster or slower playing of the past
    int recall_shot = 0, store_shot = 0;          ///< 1..9; 0: none
    int toggle_output = 0;                        ///< 1..8; 0: none

    /// Detents of a jog wheel, clockwise positive.
    double wheel_steps = 0;
    /// What a shuttle ring asks for: seconds of normal speed in this look's time, so at 2x speed
    /// twice its length.
    double shuttle_s = 0;

    /// Frames back (negative) or on, through the past.
    double past_steps = 0;
    /// Of clips, play list and playback, in their order, after what else there is of time.
    std::vector<ReplayCall> replay = {};
    /// A time code, or seconds, that the past is asked for; empty: none.
    std::string cue_time = {};

    /// True if the operator has the camera itself in hand.
    bool steers() const {
        return orbit_azimuth_rad != 0 || orbit_elevation_rad != 0 || pan_right_widths != 0 ||
               pan_up_widths != 0 || dolly != 0 || zoom != 0 || crane_up_widths != 0 ||
               look_right_rad != 0 || look_up_rad != 0 || roll_rad != 0 || pivot_m || reset ||
               recall_shot != 0;
    }
    /// True if the pivot is taken elsewhere.
    bool moves_pivot() const {
        return pan_right_widths != 0 || pan_up_widths != 0 || crane_up_widths != 0 ||
               look_right_rad != 0 || look_up_rad != 0 || pivot_m || reset || recall_shot != 0;
    }
    /// True if the move itself is to be changed.
    bool edits_move() const {
        return add_keyframe || set_keyframe || remove_keyframe || retime_s != 0;
    }
    /// True if it is about the camera on preview.
    bool commands_preview() const {
        return toggle_preview || cut || fly_to_preview || fly_to_preview_tenths != 0;
    }
    /// True if there is anything in it.
    bool is_any() const {
        return steers() || turns_wheel() || toggle_freeze || next_synthesiser || toggle_move ||
               next_wheel_mode || to_live || toggle_source_map || store_shot != 0 || past_steps != 0 ||
               toggle_tracking || toggle_jog_map || toggle_take || save_background || learn_background ||
               toggle_output != 0 || mark_in || mark_out || clear_marks || toggle_loop || cue ||
               speed_steps != 0 || !replay.empty() || !cue_time.empty() || edits_move() ||
               toggle_recording || keyframe_jump != 0 || pick || toggle_horizon || toggle_follow ||
               commands_preview();
    }
    /// True if it says where in time to be, or marks it.
    bool commands_time() const {
        return toggle_freeze || to_live || mark_in || mark_out || clear_marks || toggle_loop ||
               cue || speed_steps != 0 || past_steps != 0 || !replay.empty() || !cue_time.empty();
    }
    /// Whether the same thing is commanded in both, so that one of them would be lost in add(), or
    /// the order of what was asked of replay.
    bool commands_twice(const FlightInput& other) const;
    /// Without its commands: what it turns and shifts.
    FlightInput turns() const;
    bool turns_wheel() const { return wheel_steps != 0 || shuttle_s != 0; }

    /// Both hands together.
    void add(const FlightInput& other);
};

}  // namespace vantage
